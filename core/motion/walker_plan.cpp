#include "motion/walker_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/random.h"

namespace marey::walker {
namespace {

/// Random draws of a seed that are made once (gait) or once per step.
constexpr uint32_t kGaitChannel = 100;
constexpr uint32_t kStepChannel = 101;

/// Step length over cadence of adults walking freely, in m s (Sekiya et al. 1996, "walk ratio").
constexpr double kWalkRatio = 0.39;
constexpr double kMinStepRateHz = 1.25;
constexpr double kMaxStepM = 0.85;
constexpr double kMaxSideStepM = 0.30;

/// A foot that is nearer than this to where it should be stays.
constexpr double kRestDistanceM = 0.05;
constexpr double kRestAngle = 0.22;
constexpr double kRestCheckS = 0.02;

double wrapAngle(double a) {
  return std::remainder(a, 2.0 * std::numbers::pi);
}

/// `a` followed by the step `d`, which is expressed in a's frame.
RootFrame compose(const RootFrame& a, const RootFrame& d) {
  const double s = std::sin(a.heading);
  const double c = std::cos(a.heading);
  return {a.x + c * d.x + s * d.z, a.z - s * d.x + c * d.z, a.heading + d.heading};
}

/// The step from a to b in a's frame.
RootFrame between(const RootFrame& a, const RootFrame& b) {
  const double s = std::sin(a.heading);
  const double c = std::cos(a.heading);
  const double dx = b.x - a.x;
  const double dz = b.z - a.z;
  return {c * dx - s * dz, s * dx + c * dz, wrapAngle(b.heading - a.heading)};
}

/// `steps` further frames after `last`, each the same step as the mean of the latest ones.
std::vector<RootFrame> continued(const RootFrame& last, const RootFrame& step, int steps) {
  std::vector<RootFrame> out;
  out.reserve(static_cast<size_t>(steps));
  RootFrame frame = last;
  for (int i = 0; i < steps; ++i) out.push_back(frame = compose(frame, step));
  return out;
}

RootFrame meanStep(const RootFrame& from, const RootFrame& to, int count) {
  if (count <= 0) return {};
  const RootFrame d = between(from, to);
  return {d.x / count, d.z / count, d.heading / count};
}

double draw(uint64_t seed, uint32_t channel, uint32_t step, uint32_t index) {
  const double value = normalAt(
      {.seed = seed, .sample = channel, .frame = step, .stage = RandomStage::Walker}, index);
  return std::clamp(value, -2.0, 2.0);
}

/// Timing and size of a step at one velocity.
struct Tempo {
  double stepS, swingS, doubleSupportS, pushS, widthM, pushPitch, landPitch;
};

double stepLength(const BodyVelocity& v, const Gait& gait) {
  const double speed = std::max(v.speed(), 1e-6);
  const double backward = v.forward < 0.0 ? 0.8 : 1.0;
  const double free = gait.style.strideScale * backward * std::sqrt(kWalkRatio * speed);
  const double sideShare = std::abs(v.side) / speed;
  const double limit = kMaxStepM + (kMaxSideStepM - kMaxStepM) * sideShare;
  return std::min(free, limit);
}

Tempo tempoAt(const BodyVelocity& v, const Gait& gait) {
  const double length = stepLength(v, gait);
  // Turning on the spot has its own cadence.
  const double rate = std::max(
      {kMinStepRateHz * gait.tempo, v.speed() / length, std::min(2.2, 0.7 * std::abs(v.turn))});
  const double share = std::clamp(gait.style.stanceShare - 0.05 * (v.speed() - 1.2), 0.54, 0.72);
  Tempo out{};
  out.stepS = 1.0 / rate;
  out.swingS = 2.0 * (1.0 - share) * out.stepS;
  out.doubleSupportS = (2.0 * share - 1.0) * out.stepS;
  const double drive = std::clamp(v.forward / 1.3, 0.0, 1.3);
  out.pushS = 0.36 * out.stepS * std::min(1.0, 2.0 * drive);
  out.pushPitch = 0.78 * drive / (0.3 + 0.7 * std::max(1.0, drive));
  out.landPitch = -0.28 * std::min(1.0, drive);
  const double sideStep = std::abs(v.side) * out.stepS;
  out.widthM = std::max(gait.style.stepWidthM, sideStep + 0.10);
  return out;
}

class Planner {
 public:
  Planner(const PathCurve& path, const Gait& gait, uint64_t seed)
      : m_path(path), m_gait(gait), m_seed(seed) {
    for (int foot : {kLeft, kRight})
      m_feet[foot] = placement(foot, -kMarginS, m_gait.style.stepWidthM);
    m_plan.start = m_feet;
  }

  StepPlan run() {
    double now = -kMarginS + 0.2;
    bool resting = true;
    while (now < m_path.endS() + kMarginS - 1.0) {
      const std::optional<Step> step = nextStep(now);
      if (!step) {
        resting = true;
        now += kRestCheckS;
        continue;
      }
      accept(*step, !resting);
      resting = false;
      now = step->landS + m_tempo.doubleSupportS;
    }
    return std::move(m_plan);
  }

 private:
  Placement placement(int foot, double timeS, double widthM) const {
    const RootFrame root = m_path.at(timeS);
    const double side = foot == kLeft ? 1.0 : -1.0;
    const RootFrame at = compose(root, {side * 0.5 * widthM, -0.02, side * m_gait.toeOut});
    return {at.x, at.z, at.heading};
  }

  bool isFar(const Placement& a, const Placement& b) const {
    return std::hypot(a.x - b.x, a.z - b.z) > kRestDistanceM ||
           std::abs(wrapAngle(a.yaw - b.yaw)) > kRestAngle;
  }

  std::optional<Step> nextStep(double now);
  void accept(Step step, bool continued);

  const PathCurve& m_path;
  const Gait& m_gait;
  uint64_t m_seed;
  std::array<Placement, 2> m_feet{};
  int m_lastFoot = kRight;
  uint32_t m_count = 0;
  Tempo m_tempo{};
  StepPlan m_plan;
};

/// The step that the next foot (or, after a rest, either foot) has to make from `now` on;
/// none when both feet stand well.
std::optional<Step> Planner::nextStep(double now) {
  const BodyVelocity v = m_path.velocity(now, now + 0.7);
  m_tempo = tempoAt(v, m_gait);
  const double jitter = 1.0 + 0.03 * draw(m_seed, kStepChannel, m_count, 0);
  for (int foot : {1 - m_lastFoot, m_lastFoot}) {
    Step step;
    step.foot = foot;
    step.toeOffS = now;
    step.landS = now + m_tempo.swingS * jitter;
    // The ankle passes below the hip in the middle of its stand, later where the heel rises early.
    const double standingS = m_tempo.stepS + m_tempo.doubleSupportS - m_tempo.pushS;
    const double middle = 0.5 + 0.33 * m_tempo.pushS / m_tempo.stepS;
    step.from = m_feet[foot];
    step.to = placement(foot, step.landS + middle * standingS, m_tempo.widthM);
    if (isFar(step.from, step.to)) return step;
  }
  return std::nullopt;
}

void Planner::accept(Step step, bool continued) {
  auto& earlier = m_plan.steps[step.foot];
  const double stoodSince = earlier.empty() ? -2.0 * kMarginS : earlier.back().flatS;
  step.continued = continued;
  step.liftS = std::max(stoodSince, step.toeOffS - m_tempo.pushS);
  const double push = step.toeOffS - step.liftS;
  // A heel that has no time to rise leaves the floor together with the toe.
  if (push < 0.06) step.liftS = step.toeOffS;
  step.pushPitch = push < 0.06 ? 0.0 : m_tempo.pushPitch * std::min(1.0, push / m_tempo.pushS);
  step.landPitch = m_tempo.landPitch;
  step.flatS = step.landS + 0.12 * m_tempo.stepS * (step.landPitch < 0.0 ? 1.0 : 0.0);
  const double distance = std::hypot(step.to.x - step.from.x, step.to.z - step.from.z);
  const double height = 1.0 + 0.12 * draw(m_seed, kStepChannel, m_count, 1);
  step.heightM = m_gait.style.stepHeightM * height * std::clamp(distance / 1.2, 0.35, 0.8);
  const double scatter = 0.012 * std::min(1.0, distance / 0.3);
  step.to.x += scatter * draw(m_seed, kStepChannel, m_count, 2);
  step.to.z += scatter * draw(m_seed, kStepChannel, m_count, 3);
  step.to.yaw += 0.03 * draw(m_seed, kStepChannel, m_count, 4);
  m_feet[step.foot] = step.to;
  m_lastFoot = step.foot;
  ++m_count;
  earlier.push_back(step);
}

}  // namespace

double BodyVelocity::speed() const {
  return std::hypot(side, forward);
}

PathCurve::PathCurve(const std::vector<RootFrame>& frames, double fps)
    : m_fps(fps), m_endS(static_cast<double>(frames.size() - 1) / fps) {
  const int count = static_cast<int>(frames.size());
  const int span = std::min(count - 1, std::max(1, static_cast<int>(std::lround(0.1 * fps))));
  const int margin = static_cast<int>(std::ceil(kMarginS * fps)) + 1;
  m_beginS = -margin / fps;
  m_frames = continued(frames.front(), meanStep(frames[span], frames[0], span), margin);
  std::reverse(m_frames.begin(), m_frames.end());
  m_frames.insert(m_frames.end(), frames.begin(), frames.end());
  const auto after =
      continued(frames.back(), meanStep(frames[count - 1 - span], frames.back(), span), margin);
  m_frames.insert(m_frames.end(), after.begin(), after.end());
  for (size_t i = 1; i < m_frames.size(); ++i)
    m_frames[i].heading =
        m_frames[i - 1].heading + wrapAngle(m_frames[i].heading - m_frames[i - 1].heading);
}

RootFrame PathCurve::at(double timeS) const {
  const double position =
      std::clamp((timeS - m_beginS) * m_fps, 0.0, static_cast<double>(m_frames.size() - 1));
  const size_t k = std::min(static_cast<size_t>(position), m_frames.size() - 2);
  const double u = position - static_cast<double>(k);
  const RootFrame& a = m_frames[k];
  const RootFrame& b = m_frames[k + 1];
  return {a.x + u * (b.x - a.x), a.z + u * (b.z - a.z), a.heading + u * (b.heading - a.heading)};
}

BodyVelocity PathCurve::velocity(double fromS, double toS) const {
  const RootFrame from = at(fromS);
  const RootFrame to = at(toS);
  // Displacement seen from the mean heading: that of an arc is then along its chord.
  RootFrame middle = from;
  middle.heading = 0.5 * (from.heading + to.heading);
  const RootFrame d = between(middle, to);
  const double seconds = toS - fromS;
  return {d.x / seconds, d.z / seconds, (to.heading - from.heading) / seconds};
}

Gait drawGait(const WalkerStyle& style, uint64_t seed) {
  const auto n = [seed](uint32_t index) { return draw(seed, kGaitChannel, 0, index); };
  Gait gait{.style = style};
  gait.style.strideScale *= std::exp(0.06 * n(0));
  gait.style.stanceShare += 0.012 * n(1);
  gait.style.armSwing *= std::exp(0.25 * n(2));
  gait.style.lean += 0.025 * n(3);
  gait.style.stepHeightM *= std::exp(0.15 * n(4));
  gait.style.stepWidthM *= std::exp(0.10 * n(5));
  gait.style.bounceM *= std::exp(0.15 * n(6));
  gait.style.crouchM += 0.006 * std::abs(n(7));
  gait.toeOut += 0.05 * n(8);
  gait.elbow = std::max(0.1, gait.elbow + 0.12 * n(9));
  gait.armOut = std::max(0.05, gait.armOut + 0.04 * n(10));
  gait.tempo = std::exp(0.04 * n(11));
  return gait;
}

StepPlan planSteps(const PathCurve& path, const Gait& gait, uint64_t seed) {
  return Planner(path, gait, seed).run();
}

}  // namespace marey::walker

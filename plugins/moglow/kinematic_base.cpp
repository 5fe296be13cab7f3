#include "moglow/kinematic_base.h"

#include <ATen/CPUGeneratorImpl.h>

namespace marey::moglow {
namespace {

constexpr uint64_t kNoiseSeed = 20;  ///< of the noise through which poses are seen
constexpr double kFarthest = 3.0;    ///< normal values of feet and knees that set their spread

/// Regressors and the speeds behind them.
int64_t richCount(const Config& c, const KinematicBody& body) {
  const auto contacts = static_cast<int64_t>(body.contacts().size());
  return int64_t{c.poseDim} * c.baseOrder + 3 * c.baseOrder + 2 * contacts * (c.baseOrder - 1);
}

/// What a Foresight of this base holds, in this order.
struct Parts {
  torch::Tensor predicted, regime;
  Foreseen foreseen;
  FootGate gate;
};

std::vector<torch::Tensor> listed(const Parts& p) {
  const Foreseen& f = p.foreseen;
  const FootGate& g = p.gate;
  return {p.predicted, p.regime, f.pose, f.last,  f.places,    f.hold,      f.lengths,
          g.foreseen,  g.knee,   g.skew, g.radii, g.kneeSlope, g.boneSlope, g.slack};
}

Parts partsIn(const Foresight& foresight) {
  const auto& p = foresight.parts;
  return {
      p[0], p[1], {p[2], p[3], p[4], p[5], p[6]}, {p[7], p[8], p[9], p[10], p[11], p[12], p[13]}};
}

}  // namespace

BufferMaker KinematicBase::keeper() {
  return
      [this](const char* name, const torch::Tensor& start) { return register_buffer(name, start); };
}

KinematicBase::KinematicBase(const Config& c, const BodyFacts& facts)
    : m_body(c, facts, keeper()),
      m_step(c, keeper()),
      m_feet(c, m_body, keeper()),
      m_regimes(c, m_body, richCount(c, m_body), keeper()),
      m_sight(c, m_body, richCount(c, m_body), keeper()) {}

Foresight KinematicBase::foresee(const BaseInput& input) const {
  const torch::NoGradGuard guard;  // nothing here is trained
  const Past past = m_body.pastOf(input);
  const auto rich = richRegressors(m_body, past);
  const auto regime = m_regimes.regimeOf(m_body, past);
  const auto predicted = m_regimes.predicted(past, rich, regime);
  const auto clusters = m_feet.clustersOf(m_body, past);
  return {m_sight.see(m_body, past, rich),
          listed({predicted * m_body.predictable(), regime,
                  m_feet.foreseen(m_body, past, m_step.foreseen(m_body, past), clusters),
                  m_feet.gate(m_body, past, clusters, predicted)})};
}

PoseBase::Innovation KinematicBase::toInnovation(const torch::Tensor& pose,
                                                 const Foresight& foresight) const {
  const Parts p = partsIn(foresight);
  const auto local = toChart(m_body.chart(), m_body.toCentimetres(pose), p.foreseen, p.gate);
  const auto whitened = m_regimes.whitened(local.value.flatten(1) - p.predicted, p.regime);
  // Density of standardised poses, not of centimetres.
  return {whitened.value, local.logDet + whitened.logDet + m_body.logDeterminant()};
}

torch::Tensor KinematicBase::toPose(const torch::Tensor& innovation,
                                    const Foresight& foresight) const {
  const Parts p = partsIn(foresight);
  const auto local =
      (m_regimes.residual(innovation, p.regime) + p.predicted).view({innovation.size(0), -1, 3});
  return m_body.toStandard(fromChart(m_body.chart(), local, p.foreseen, p.gate));
}

void KinematicBase::fit(const torch::Tensor& poses, const BaseInput& input,
                        const torch::Tensor& noise) {
  const torch::NoGradGuard guard;
  const auto motion = m_body.toCentimetres(poses);
  m_body.fitChart(motion);
  const Past past = m_body.pastOf(input);
  m_feet.fitLimits(m_body, motion, past);
  m_step.fit(m_body, motion, past);
  const auto step = m_step.foreseen(m_body, past);
  m_feet.fitHold(m_body, motion, past, step);
  // The body and what holds its feet are those of the motion; how far it strays, of what is seen.
  auto pose = motion;
  double floor = 0.0;
  if (noise.defined()) {
    auto generator = at::detail::createCPUGenerator(kNoiseSeed);
    const auto drawn = torch::randn(poses.sizes(), generator, torch::kFloat32).to(poses.device());
    pose = m_body.toCentimetres(poses + drawn * noise);
    floor = m_body.leastNoise(noise);
  }
  const BoneChart chart = m_body.chart();
  const auto clusters = m_feet.clustersOf(m_body, past);
  const Foreseen foreseen = m_feet.foreseen(m_body, past, step, clusters);
  m_regimes.fit(m_body, chartCoordinates(chart, pose, foreseen).flatten(1), past);
  const auto rich = richRegressors(m_body, past);
  const auto regime = m_regimes.regimeOf(m_body, past);
  const auto predicted = m_regimes.predicted(past, rich, regime);
  const KinematicFeet::Footing footing{clusters, foreseen,
                                       m_feet.gate(m_body, past, clusters, predicted),
                                       footPlaces(chart, pose, foreseen), footScales(m_body, past)};
  m_feet.fitGate(footing, floor);
  m_feet.fitLegs(m_body, pose, footing, floor);
  const auto local = toChart(chart, pose, foreseen, m_feet.gate(m_body, past, clusters, predicted))
                         .value.flatten(1);
  // The few frames in which feet leave would otherwise set the spread of all.
  const auto residual = local - predicted * m_body.predictable();
  m_regimes.fitWhitening(
      torch::where(m_body.predictable().eq(0.0), residual.clamp(-kFarthest, kFarthest), residual),
      regime);
  m_sight.fit(rich);
}

}  // namespace marey::moglow

#include "render/scene/tracks.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace marey::render {

namespace {
/// Between neighbours side by side, metres.
constexpr float gapM = 0.35F;

std::shared_ptr<const Clip> checked(std::shared_ptr<const Clip> clip) {
  if (!clip) throw InputError({.path = "scene"}, "a clip for every motion", "none");
  validate(*clip);
  return clip;
}

double turned(double from, double to, double share) {
  return from + share * std::remainder(to - from, 2.0 * M_PI);
}
}  // namespace

Track::Track(std::shared_ptr<const Clip> clip)
    : m_clip(checked(std::move(clip))),
      m_shape(bodyShape(*m_clip->skeleton, m_clip->frame(0))),
      m_low(m_clip->positions.front()),
      m_high(m_clip->positions.front()) {
  for (const Vec3& p : m_clip->positions) {
    m_low = m_low.cwiseMin(p);
    m_high = m_high.cwiseMax(p);
  }
}

const std::vector<Rest>& Track::rests(const stats::ContactRule& rule) const {
  if (!m_rests || m_restRule != rule) m_rests = feetAtRest(*m_clip, rule);
  m_restRule = rule;
  return *m_rests;
}

void Track::needRoots() const {
  if (m_roots.empty()) m_roots = rootTrajectory(*m_clip, FeatureSpec{});
}

Track::Moment Track::momentAt(double timeS) const {
  const double at = std::clamp(timeS * m_clip->fps, 0.0, m_clip->frameCount() - 1.0);
  const int before = static_cast<int>(at);
  return {before, std::min(before + 1, m_clip->frameCount() - 1), static_cast<float>(at - before)};
}

Eigen::Isometry3f Track::placing(const Moment& moment, Placement placement) const {
  Eigen::Isometry3f result = Eigen::Isometry3f::Identity();
  if (placement == Placement::SideBySide) result.translation() = shift;
  if (placement != Placement::RootAligned) return result;
  needRoots();
  const RootFrame& a = m_roots[static_cast<size_t>(moment.before)];
  const RootFrame& b = m_roots[static_cast<size_t>(moment.after)];
  const double heading = turned(a.heading, b.heading, moment.share);
  const Vec3 root(static_cast<float>(std::lerp(a.x, b.x, moment.share)), 0.0F,
                  static_cast<float>(std::lerp(a.z, b.z, moment.share)));
  result.rotate(Eigen::AngleAxisf(static_cast<float>(-heading), Vec3::UnitY()));
  result.translate(-root);
  return result;
}

void Track::pose(double timeS, Placement placement, std::span<Vec3> out) const {
  const Moment m = momentAt(timeS);
  const auto before = m_clip->frame(m.before), after = m_clip->frame(m.after);
  const float share = m.share;
  for (size_t j = 0; j < out.size(); ++j) out[j] = before[j] + share * (after[j] - before[j]);
  if (placement == Placement::World) return;
  const Eigen::Isometry3f place = placing(m, placement);
  for (Vec3& p : out) p = place * p;
}

Vec3 Track::joint(double timeS, int joint, Placement placement) const {
  const Moment m = momentAt(timeS);
  const Vec3& before = m_clip->at(m.before, joint);
  const Vec3 p = before + m.share * (m_clip->at(m.after, joint) - before);
  return placement == Placement::World ? p : Vec3(placing(m, placement) * p);
}

Vec3 travelOf(std::span<const std::shared_ptr<Track>> tracks) {
  std::vector<Vec3> roots;
  if (!tracks.empty()) {
    const Clip& clip = tracks.front()->clip();
    for (int t = 0; t < clip.frameCount(); ++t) roots.push_back(clip.at(t, 0));
  }
  return travelDirection(roots, Vec3::UnitZ());
}

void placeSideBySide(std::span<const std::shared_ptr<Track>> tracks) {
  if (tracks.empty()) return;
  const Vec3 left = Vec3::UnitY().cross(travelOf(tracks));
  struct Width {
    float low = 1e9F, high = -1e9F;
  };
  std::vector<Width> widths(tracks.size());
  float middle = 0.0F, total = -gapM;
  for (size_t m = 0; m < tracks.size(); ++m) {
    for (const Vec3& p : tracks[m]->clip().positions) {
      widths[m].low = std::min(widths[m].low, p.dot(left));
      widths[m].high = std::max(widths[m].high, p.dot(left));
    }
    middle += 0.5F * (widths[m].low + widths[m].high) / static_cast<float>(tracks.size());
    total += widths[m].high - widths[m].low + gapM;
  }
  float at = middle + 0.5F * total;
  for (size_t m = 0; m < tracks.size(); ++m) {
    tracks[m]->shift = (at - widths[m].high) * left;
    at -= widths[m].high - widths[m].low + gapM;
  }
}

}  // namespace marey::render

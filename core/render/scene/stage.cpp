#include "render/scene/stage.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "render/scene/backdrop.h"
#include "render/scene/endings.h"

namespace marey::render {

namespace {
constexpr size_t manyFigures = 400;  ///< above, Auto draws lines

void checkMotion(const SceneMotion& motion, const Track& track) {
  const auto frames = static_cast<size_t>(track.clip().frameCount());
  if (motion.frameColours.empty() || motion.frameColours.size() == frames) return;
  throwInput({.path = "motion '" + motion.label + "'"}, fmt::format("{} frame colours", frames),
             "{}", motion.frameColours.size());
}

/// Tracks of clips that were there before are kept: what was worked out from them is not lost.
std::vector<std::shared_ptr<Track>> tracksFor(const std::vector<SceneMotion>& motions,
                                              std::span<const std::shared_ptr<Track>> before) {
  std::multimap<const Clip*, std::shared_ptr<Track>> known;
  for (const auto& track : before) known.emplace(&track->clip(), track);
  std::vector<std::shared_ptr<Track>> tracks;
  for (const SceneMotion& motion : motions) {
    const auto found = known.find(motion.clip.get());
    if (found == known.end()) {
      tracks.push_back(std::make_shared<Track>(motion.clip));
    } else {
      tracks.push_back(found->second);
      known.erase(found);
    }
    checkMotion(motion, *tracks.back());
  }
  return tracks;
}

Vec3 level(const Vec3& v) {
  return {v.x(), 0.0F, v.z()};
}

/// The head is a ball around no joint.
void addHead(std::vector<Vec3>& points, const BodyShape& shape, std::span<const Vec3> pose,
             const Vec3& shift) {
  if (shape.head < 0) return;
  const Vec3 head = headCentre(shape, pose) + shift;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-shape.headRadiusM, shape.headRadiusM})
      points.emplace_back(head + side * Vec3::Unit(axis));
}
}  // namespace

bool isSolid(double opacity) {
  return opacity > 0.995;
}

void Stage::setMotions(std::vector<SceneMotion> motions) {
  auto tracks = tracksFor(motions, m_tracks);
  if (m_options.placement == Placement::RootAligned)
    for (const auto& track : tracks) track->needRoots();
  m_tracks = std::move(tracks);
  m_motions = std::move(motions);
  m_someHighlighted = std::any_of(m_motions.begin(), m_motions.end(),
                                  [](const SceneMotion& m) { return m.highlighted; });
  update();
}

void Stage::setOptions(SceneOptions options) {
  if (!(options.strobe.everyS >= 0.0))
    throwInput({.path = "scene"}, "a time between figures of 0 s or more", "{} s",
               options.strobe.everyS);
  if (options.placement == Placement::RootAligned)
    for (const auto& track : m_tracks) track->needRoots();
  m_options = std::move(options);
  update();
}

void Stage::setTime(double seconds) {
  m_time = seconds;
  m_posesCurrent = false;
}

double Stage::longestS() const {
  double longest = 0.0;
  for (const auto& track : m_tracks) longest = std::max(longest, track->lastS());
  return longest;
}

std::span<const Vec3> Stage::pose(size_t motion) const {
  if (!m_posesCurrent) {
    m_offsets.assign(1, 0);
    for (const auto& track : m_tracks)
      m_offsets.push_back(m_offsets.back() + static_cast<size_t>(track->jointCount()));
    m_poses.resize(m_offsets.back());
    for (size_t m = 0; m < m_tracks.size(); ++m)
      m_tracks[m]->pose(m_time, m_options.placement,
                        std::span(m_poses).subspan(m_offsets[m], m_offsets[m + 1] - m_offsets[m]));
    m_posesCurrent = true;
  }
  return std::span(m_poses).subspan(m_offsets[motion], m_offsets[motion + 1] - m_offsets[motion]);
}

Colour Stage::colour(size_t motion, double timeS) const {
  const SceneMotion& m = m_motions[motion];
  Colour colour = m.colour;
  if (!m.frameColours.empty()) {
    const double last = static_cast<double>(m.frameColours.size() - 1);
    colour =
        m.frameColours[static_cast<size_t>(std::clamp(std::round(timeS * m.clip->fps), 0.0, last))];
  }
  if (m_options.tone == Tone::Dark) colour = onDark(colour);
  colour.a = m.highlighted ? 1.0 : std::clamp(m.opacity, 0.0, 1.0);
  colour.a *= presenceAt(timeS, m_tracks[motion]->lastS());
  if (m.highlighted || !m_someHighlighted) return colour;
  const double kept = isSolid(colour.a) ? 1.0 : 0.45 * colour.a;
  return withOpacity(mix(colour, backdropOf(m_options.tone).floor, 0.62), kept);
}

bool Stage::asLines() const {
  if (m_options.detail != BodyDetail::Auto) return m_options.detail == BodyDetail::Lines;
  return m_motions.size() > manyFigures;
}

template <class Shift>
std::vector<Vec3> Stage::figureOutline(Shift&& shiftAt) const {
  std::vector<Vec3> points;
  std::vector<Vec3> pose;
  // Enough moments to be near every extreme; fewer where there are many motions.
  const double most = std::max(4.0, 4000.0 / static_cast<double>(m_tracks.size() + 1));
  for (const auto& track : m_tracks) {
    const int moments = static_cast<int>(std::clamp(10.0 * track->lastS(), 1.0, most));
    pose.resize(static_cast<size_t>(track->jointCount()));
    for (int k = 0; k <= moments; ++k) {
      const double at = track->lastS() * k / moments;
      track->pose(at, m_options.placement, pose);
      const Vec3 shift = shiftAt(at);
      for (const Vec3& p : pose) points.emplace_back(p + shift);
      addHead(points, track->shape(), pose, shift);
    }
  }
  return points;
}

std::vector<Vec3> Stage::outline() const {
  std::vector<Vec3> points = figureOutline([](double) { return Vec3(Vec3::Zero()); });
  if (!marksInPlace()) return points;
  const bool aside = m_options.placement == Placement::SideBySide;
  for (const RootFrame& f : m_options.path) {
    const Vec3 p(static_cast<float>(f.x), 0.0F, static_cast<float>(f.z));
    if (!aside) points.push_back(p);
    for (size_t m = 0; aside && m < m_tracks.size(); ++m)
      points.emplace_back(p + m_tracks[m]->shift);
  }
  return points;
}

std::vector<Vec3> Stage::outlineAround(const Vec3& followed) const {
  constexpr double stepS = 0.1;
  std::vector<Vec3> shifts;
  for (double at = 0.0; at <= longestS() + stepS; at += stepS)
    shifts.emplace_back(followed - meanRoot(at));
  return figureOutline(
      [&](double at) { return shifts[static_cast<size_t>(std::round(at / stepS))]; });
}

Vec3 Stage::meanRoot(double timeS) const {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (size_t m = 0; m < m_tracks.size(); ++m) {
    if (m_someHighlighted && !m_motions[m].highlighted) continue;
    // Averaged over a second.
    for (int k = -2; k <= 2; ++k)
      sum += m_tracks[m]->joint(timeS + 0.25 * k, 0, m_options.placement);
    count += 5;
  }
  return count == 0 ? Vec3::Zero() : level(sum / static_cast<float>(count));
}

Vec3 Stage::travel() const {
  return m_options.placement == Placement::RootAligned ? Vec3(Vec3::UnitZ()) : travelOf(m_tracks);
}

double Stage::spreadM() const {
  if (m_tracks.empty()) return 0.0;
  Vec3 low = m_tracks.front()->joint(0.0, 0, m_options.placement), high = low;
  const auto include = [&](const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const auto& track : m_tracks)
    for (double at = 0.0; at <= track->lastS(); at += 0.25)
      include(track->joint(at, 0, m_options.placement));
  for (const RootFrame& f : m_options.path)
    if (m_options.placement == Placement::World)
      include({static_cast<float>(f.x), 0.0F, static_cast<float>(f.z)});
  return std::min(high.x() - low.x(), high.z() - low.z());
}

void Stage::update() {
  if (m_options.placement == Placement::SideBySide) placeSideBySide(m_tracks);
  m_posesCurrent = false;
  const std::vector<Vec3> points = outline();
  m_extent = {};
  if (!points.empty()) {
    Vec3 low = points.front(), high = points.front();
    for (const Vec3& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    m_extent.centre = 0.5F * (low + high);
    m_extent.radius = 0.5F * (high - low).norm() + 0.5F;
    m_extent.floorRadius = 0.5F * level(high - low).norm();
  }
  m_extent.floorRadius = 1.7F * m_extent.floorRadius + 5.0F;
}

}  // namespace marey::render

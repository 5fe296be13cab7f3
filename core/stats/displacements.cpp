#include "stats/displacements.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace marey::stats {
namespace {

double floorDistance(const Vec3& a, const Vec3& b) {
  return std::hypot(static_cast<double>(a.x()) - b.x(), static_cast<double>(a.z()) - b.z());
}

/// Whether the joint kept within `radius` of where it is at frame t over the `frames` steps before.
bool restsAt(const Clip& clip, int joint, int t, int first, int frames, double radius) {
  if (t - frames < first) return false;
  for (int k = t - frames; k < t; ++k)
    if (floorDistance(clip.at(k, joint), clip.at(t, joint)) > radius) return false;
  return true;
}

}  // namespace

int displacements(const Clip& clip, int joint, int first, int last, const DisplacementRule& rule) {
  const int frames = std::max(1, static_cast<int>(std::lround(rule.restS * clip.fps)));
  std::optional<Vec3> rest;  // the last one
  bool resting = false;
  int count = 0;
  for (int t = std::max(0, first); t < std::min(last, clip.frameCount()); ++t) {
    const Vec3& at = clip.at(t, joint);
    if (resting) {
      resting = floorDistance(at, *rest) <= rule.leaveM;
      continue;
    }
    if (!restsAt(clip, joint, t, std::max(0, first), frames, rule.restM)) continue;
    resting = true;
    if (rest && floorDistance(at, *rest) > rule.leaveM) ++count;
    rest = at;
  }
  return count;
}

int displacements(const Clip& clip, int joint, const DisplacementRule& rule) {
  return displacements(clip, joint, 0, clip.frameCount(), rule);
}

}  // namespace marey::stats

#include "motion/standing.h"

#include <cmath>
#include <numbers>

namespace marey {
namespace {

/// Whether the step from frame a to frame b is one of standing.
bool stands(const RootFrame& a, const RootFrame& b, double fps) {
  const double turn = std::remainder(b.heading - a.heading, 2.0 * std::numbers::pi);
  return std::hypot(b.x - a.x, b.z - a.z) * fps < kStandingMS &&
         std::abs(turn) * fps < kStandingRadS;
}

}  // namespace

std::vector<Stand> standsOf(const std::vector<RootFrame>& path, double fps) {
  std::vector<Stand> out;
  const int frames = static_cast<int>(path.size());
  int begin = 0;
  for (int t = 1; t <= frames; ++t) {
    if (t < frames && stands(path[static_cast<size_t>(t - 1)], path[static_cast<size_t>(t)], fps))
      continue;
    if (t - begin > kShortestStandS * fps) out.push_back({begin, t});
    begin = t;
  }
  return out;
}

double standingSeconds(const std::vector<RootFrame>& path, double fps) {
  double frames = 0.0;
  for (const auto& [first, last] : standsOf(path, fps)) frames += last - first - 1;
  return frames / fps;
}

}  // namespace marey

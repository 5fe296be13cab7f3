#include "stats/trajectories.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace marey::stats {

JerkTally jerk(const Clip& clip) {
  const double cubedRate = clip.fps * clip.fps * clip.fps;
  const auto p = [&](int t, int joint) -> Eigen::Vector3d {
    return clip.at(t, joint).cast<double>();
  };
  JerkTally tally;
  for (int t = 3; t < clip.frameCount(); ++t)
    for (int j = 0; j < clip.jointCount(); ++j) {
      const Eigen::Vector3d d = p(t, j) - p(t - 3, j) - 3.0 * (p(t - 1, j) - p(t - 2, j));
      tally.sum += d.norm() * cubedRate;
      tally.count += 1.0;
    }
  return tally;
}

PathError pathError(const std::vector<RootFrame>& walked, const std::vector<RootFrame>& wanted) {
  const size_t frames = std::min(walked.size(), wanted.size());
  if (frames == 0) throw InputError({.path = "path error"}, "two trajectories", "an empty one");
  PathError out;
  for (size_t t = 0; t < frames; ++t) {
    out.finalM = std::hypot(walked[t].x - wanted[t].x, walked[t].z - wanted[t].z);
    out.meanM += out.finalM / static_cast<double>(frames);
    out.maximumM = std::max(out.maximumM, out.finalM);
    out.headingMeanRad +=
        std::abs(std::remainder(walked[t].heading - wanted[t].heading, 2.0 * std::numbers::pi)) /
        static_cast<double>(frames);
  }
  return out;
}

}  // namespace marey::stats

#include "stats/skate.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "stats/footsteps.h"
#include "stats/sample_distance.h"

namespace marey::stats {
namespace {

constexpr double kWeightHeightM = 0.025;
constexpr double kLowFootM = 0.05;
constexpr double kSkateCmS = 50.0;
/// sqrt(0.02 cm^2) thirty times a second.
const double kContactCmS = 30.0 * std::sqrt(0.02);

double heightAt(const Clip& clip, int t, int joint, double standing) {
  return std::max(0.0, clip.at(t, joint).y() - standing);
}

double speedCmS(const Clip& clip, int t, int joint) {
  const Vec3 d = clip.at(t, joint) - clip.at(t - 1, joint);
  return 100.0 * clip.fps * d.cast<double>().norm();
}

}  // namespace

std::vector<double> standingHeights(const std::vector<Clip>& clips, const std::vector<int>& feet) {
  std::vector<double> out;
  for (int foot : feet) {
    std::vector<double> heights;
    for (const Clip& clip : clips)
      for (int t = 0; t < clip.frameCount(); ++t) heights.push_back(clip.at(t, foot).y());
    if (heights.empty()) throw InputError({.path = "clips"}, "at least one frame", "none");
    std::sort(heights.begin(), heights.end());
    out.push_back(sortedQuantile(heights, 0.05));
  }
  return out;
}

SkateTally heightWeightedSkate(const Clip& clip, const std::vector<int>& feet,
                               const std::vector<double>& standingHeights) {
  SkateTally tally;
  for (size_t f = 0; f < feet.size(); ++f) {
    const auto speeds = horizontalSpeedsCmS(clip, feet[f]);
    for (int t = 1; t < clip.frameCount(); ++t) {
      const double height = heightAt(clip, t, feet[f], standingHeights[f]);
      if (height <= kWeightHeightM)
        tally.sum += speeds[t - 1] * (2.0 - std::exp2(height / kWeightHeightM));
      tally.frames += 1.0;
    }
  }
  return tally;
}

SkateTally skatingShare(const Clip& clip, const std::vector<int>& feet,
                        const std::vector<double>& standingHeights) {
  SkateTally tally;
  for (int t = 1; t < clip.frameCount(); ++t) {
    bool skates = false;
    for (size_t f = 0; f < feet.size(); ++f) {
      const bool low = heightAt(clip, t, feet[f], standingHeights[f]) < kLowFootM &&
                       heightAt(clip, t - 1, feet[f], standingHeights[f]) < kLowFootM;
      const Vec3 d = clip.at(t, feet[f]) - clip.at(t - 1, feet[f]);
      const double speed = 100.0 * clip.fps * std::hypot(d.x(), d.z());
      skates = skates || (low && speed > kSkateCmS);
    }
    tally.sum += skates ? 1.0 : 0.0;
    tally.frames += 1.0;
  }
  return tally;
}

SkateTally contactShare(const Clip& clip, const std::vector<int>& feet) {
  SkateTally tally;
  for (int foot : feet)
    for (int t = 1; t < clip.frameCount(); ++t) {
      tally.sum += speedCmS(clip, t, foot) < kContactCmS ? 1.0 : 0.0;
      tally.frames += 1.0;
    }
  return tally;
}

}  // namespace marey::stats

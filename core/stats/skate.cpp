#include "stats/skate.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/quantile.h"
#include "stats/footsteps.h"
#include "stats/sample_distance.h"

namespace marey::stats {
namespace {

constexpr double kWeightHeightM = 0.025;
constexpr float kLowFootM = 0.05f;
constexpr double kSkateCmS = 50.0;
constexpr size_t kSkateWindow = 5;  ///< frames
/// sqrt(0.02 cm^2) thirty times a second.
const double kContactCmS = 30.0 * std::sqrt(0.02);

double heightAt(const Clip& clip, int t, int joint, double standing) {
  return std::max(0.0, clip.at(t, joint).y() - standing);
}

/// Mean of five values about one, zeros beyond the ends.
double centredMean(const std::vector<double>& values, size_t at) {
  constexpr size_t kHalf = kSkateWindow / 2;
  double sum = 0.0;
  for (size_t i = at < kHalf ? 0 : at - kHalf; i <= at + kHalf && i < values.size(); ++i)
    sum += values[i];
  return sum / kSkateWindow;
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

SkateTally skatingShare(const Clip& clip, const std::vector<int>& toes) {
  std::vector<bool> skates(static_cast<size_t>(std::max(0, clip.frameCount() - 1)), false);
  for (const int toe : toes) {
    const std::vector<double> speeds = horizontalSpeedsCmS(clip, toe);
    for (size_t i = 0; i < speeds.size(); ++i) {
      const int t = static_cast<int>(i) + 1;
      const bool low = clip.at(t, toe).y() < kLowFootM && clip.at(t - 1, toe).y() < kLowFootM;
      if (low && speeds[i] > kSkateCmS && centredMean(speeds, i) > kSkateCmS) skates[i] = true;
    }
  }
  return {static_cast<double>(std::count(skates.begin(), skates.end(), true)),
          static_cast<double>(skates.size())};
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

#include "stats/footsteps.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "motion/roles.h"
#include "stats/controls.h"

namespace marey::stats {
namespace {

/// Of a sum of shares, relative: far above the rounding of a million terms, far below one step.
constexpr double kRounding = 1e-9;

/// One run of slow frames after another: run(first, length) in indices of `speeds`.
template <typename Run>
void forEachRun(const std::vector<double>& speeds, double tolerance, Run run) {
  size_t length = 0;
  for (size_t i = 0; i <= speeds.size(); ++i) {
    if (i < speeds.size() && speeds[i] < tolerance) {
      ++length;
      continue;
    }
    if (length > 0) run(i - length, length);
    length = 0;
  }
}

void checkFeet(const Clip& clip, const std::vector<int>& feet) {
  for (int foot : feet)
    if (foot < 0 || foot >= clip.jointCount())
      throwInput({.path = clip.name, .item = "feet"},
                 fmt::format("joints 0..{}", clip.jointCount() - 1), "{}", foot);
}

}  // namespace

std::vector<int> feetOf(const Skeleton& skeleton, const std::string& names) {
  std::vector<int> feet = names.empty() ? rolesOf(skeleton).feet : jointsByName(skeleton, names);
  if (!feet.empty()) return feet;
  std::string joints;
  for (const std::string& name : skeleton.names) joints += (joints.empty() ? "" : ", ") + name;
  throw InputError({.path = "skeleton", .item = "feet"},
                   "joints named as feet (or a choice of them)", joints);
}

std::vector<int> toesOf(const Skeleton& skeleton, const std::vector<int>& feet) {
  std::vector<int> out;
  for (const int foot : feet) {
    std::vector<int> children;
    int named = -1;
    for (int j = 0; j < skeleton.jointCount(); ++j) {
      if (skeleton.parents[static_cast<size_t>(j)] != foot) continue;
      children.push_back(j);
      std::string name = skeleton.names[static_cast<size_t>(j)];
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (named < 0 && name.find("toe") != std::string::npos) named = j;
    }
    out.push_back(named >= 0 ? named : children.size() == 1 ? children.front() : foot);
  }
  return out;
}

std::vector<double> horizontalSpeedsCmS(const Clip& clip, int joint) {
  std::vector<double> speeds;
  for (int t = 1; t < clip.frameCount(); ++t) {
    const Eigen::Vector3d d =
        clip.at(t, joint).cast<double>() - clip.at(t - 1, joint).cast<double>();
    speeds.push_back(100.0 * std::hypot(d.x(), d.z()) * clip.fps);
  }
  return speeds;
}

std::vector<double> footstepTolerances(const FootstepOptions& options) {
  if (!(options.stepCmS > 0.0) || !(options.maximumCmS >= options.stepCmS))
    throwInput({.path = "footsteps", .item = "tolerance step"},
               fmt::format("more than 0 and at most {} cm/s", options.maximumCmS), "{} cm/s",
               options.stepCmS);
  const auto count = static_cast<int>(std::floor(options.maximumCmS / options.stepCmS + 1e-9));
  std::vector<double> out;
  // Rounded, so that three steps of 0.3 are 0.9 and not its neighbour.
  for (int k = 1; k <= count; ++k) out.push_back(std::round(k * options.stepCmS * 1e9) / 1e9);
  return out;
}

FootstepTally footstepTally(const Clip& clip, const FootstepOptions& options) {
  checkFeet(clip, options.feet);
  const std::vector<double> tolerances = footstepTolerances(options);
  FootstepTally tally{.lengthS = clip.seconds()};
  for (auto* sums : {&tally.count, &tally.seconds, &tally.squaredSeconds})
    sums->assign(tolerances.size(), 0.0);
  for (int foot : options.feet) {
    const std::vector<double> speeds = horizontalSpeedsCmS(clip, foot);
    for (size_t k = 0; k < tolerances.size(); ++k)
      forEachRun(speeds, tolerances[k], [&](size_t, size_t length) {
        const double seconds = static_cast<double>(length) / clip.fps;
        tally.count[k] += 1.0;
        tally.seconds[k] += seconds;
        tally.squaredSeconds[k] += seconds * seconds;
      });
  }
  return tally;
}

FootstepCurve curveOf(const std::vector<double>& tolerances,
                      const std::vector<FootstepTally>& tallies,
                      const std::vector<double>& weights) {
  FootstepCurve curve{.toleranceCmS = tolerances, .count = {}};
  curve.count.assign(tolerances.size(), 0.0);
  for (size_t i = 0; i < tallies.size(); ++i) {
    curve.lengthS += weights[i] * tallies[i].lengthS;
    for (size_t k = 0; k < tallies[i].count.size(); ++k)
      curve.count[k] += weights[i] * tallies[i].count[k];
  }
  if (!curve.count.empty())
    curve.maxCount = *std::max_element(curve.count.begin(), curve.count.end());
  if (curve.maxCount == 0.0) {
    curve.v95CmS = std::numeric_limits<double>::quiet_NaN();
    return curve;
  }
  // 0.95 * max has no exact double, and shares of a third add up to almost a whole number.
  const auto first = std::find_if(curve.count.begin(), curve.count.end(), [&](double f) {
    return 100.0 * f >= 95.0 * curve.maxCount * (1.0 - kRounding);
  });
  const auto k = static_cast<size_t>(first - curve.count.begin());
  curve.v95CmS = tolerances[k];
  double sum = 0.0;
  double squares = 0.0;
  for (size_t i = 0; i < tallies.size(); ++i) {
    if (tallies[i].count.empty()) continue;
    sum += weights[i] * tallies[i].seconds[k];
    squares += weights[i] * tallies[i].squaredSeconds[k];
  }
  const double n = curve.count[k];
  curve.durationMeanS = sum / n;
  curve.durationStdS = std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
  curve.stepsPerS = n / curve.lengthS;
  return curve;
}

FootstepCurve footstepCurve(const std::vector<Clip>& clips, const FootstepOptions& options,
                            const std::vector<int>& controls) {
  if (clips.empty()) throw InputError({.path = "footsteps"}, "at least one clip", "none");
  if (options.feet.empty()) throw InputError({.path = "footsteps"}, "at least one foot", "none");
  std::vector<FootstepTally> tallies;
  tallies.reserve(clips.size());
  for (const Clip& clip : clips) tallies.push_back(footstepTally(clip, options));
  const ControlSets sets(controls.empty() ? controlsEach(clips.size()) : controls, {});
  return curveOf(footstepTolerances(options), tallies, sets.once().clips);
}

std::vector<ContactInterval> contactIntervals(const Clip& clip, const std::vector<int>& feet,
                                              double toleranceCmS) {
  checkFeet(clip, feet);
  std::vector<ContactInterval> out;
  for (int foot : feet)
    forEachRun(horizontalSpeedsCmS(clip, foot), toleranceCmS, [&](size_t first, size_t length) {
      // Index i of the speeds is frame i + 1.
      const int firstFrame = static_cast<int>(first) + 1;
      out.push_back({.joint = foot,
                     .firstFrame = firstFrame,
                     .lastFrame = firstFrame + static_cast<int>(length) - 1,
                     .seconds = static_cast<double>(length) / clip.fps});
    });
  return out;
}

std::vector<ContactInterval> contactIntervals(const Clip& clip, const ContactRule& rule) {
  std::vector<int> feet;
  try {
    feet = feetOf(*clip.skeleton, rule.feet);
  } catch (const InputError&) {
    return {};
  }
  return contactIntervals(clip, feet, rule.toleranceCmS);
}

}  // namespace marey::stats

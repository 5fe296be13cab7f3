#include "gui/plots/diversity_data.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "gui/plots/count_strip.h"

#include "base/error.h"
#include "stats/diversity.h"

namespace marey::gui {
namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One motion as pairs compare it. Throws InputError unless it has joints and rate of `first`.
Matrix rootFramePose(const Clip& clip, const Clip& first) {
  if (clip.fps != first.fps)
    throwInput({.path = clip.name}, fmt::format("{} fps as the other motions", first.fps), "{}",
               clip.fps);
  requireJointsOf(clip, first);
  return stats::rootFramePoses(clip);
}

/// Mean over the compared motions but `itself` (an index into them; -1: it is none of them).
std::vector<float> distancesFrom(const Matrix& pose, const std::vector<Matrix>& compared,
                                 int itself) {
  std::vector<float> out;
  for (Eigen::Index t = 0; t < pose.rows(); ++t) {
    double sum = 0.0;
    int others = 0;
    for (size_t j = 0; j < compared.size(); ++j) {
      if (static_cast<int>(j) == itself || t >= compared[j].rows()) continue;
      sum += 100.0 * stats::poseDistance(pose, compared[j], t);
      ++others;
    }
    out.push_back(static_cast<float>(others > 0 ? sum / others : kNaN));
  }
  return out;
}

/// Whether the motions were not made along one path.
bool differentControls(const MotionSet& set) {
  if (set.natural) return true;
  return std::adjacent_find(set.follows.begin(), set.follows.end(), std::not_equal_to<>()) !=
         set.follows.end();
}

DiversityCurve curveOf(const MotionSet& set, Progress& progress) {
  const Clip& first = *set.clips.front();
  const std::vector<int> chosen =
      stats::spreadIndices(static_cast<int>(set.clips.size()), stats::kDiversityMotions);
  std::vector<Matrix> poses;
  for (const int i : chosen) {
    progress.throwIfCancelled();
    poses.push_back(rootFramePose(*set.clips[static_cast<size_t>(i)], first));
  }
  DiversityCurve curve{
      .look = lookOf(set), .fps = first.fps, .compared = static_cast<int>(poses.size())};
  if (differentControls(set)) curve.look.name += " (different controls)";
  progress.throwIfCancelled();
  curve.pairs = stats::pairCurve(poses);
  for (size_t i = 0; i < set.clips.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(set.clips.size()));
    const auto at = std::lower_bound(chosen.begin(), chosen.end(), static_cast<int>(i));
    const bool known = at != chosen.end() && *at == static_cast<int>(i);
    const auto k = static_cast<size_t>(at - chosen.begin());
    curve.motionsCm.push_back(known
                                  ? distancesFrom(poses[k], poses, static_cast<int>(k))
                                  : distancesFrom(rootFramePose(*set.clips[i], first), poses, -1));
  }
  return curve;
}
}  // namespace

std::vector<DiversityCurve> diversityCurves(const std::vector<MotionSet>& sets, Progress& progress,
                                            std::vector<std::string>* leftOut) {
  std::vector<DiversityCurve> out;
  for (size_t s = 0; s < sets.size(); ++s) {
    if (sets[s].clips.size() < 2) continue;
    Progress part = progress.part(static_cast<double>(s) / static_cast<double>(sets.size()),
                                  static_cast<double>(s + 1) / static_cast<double>(sets.size()));
    try {
      out.push_back(curveOf(sets[s], part));
    } catch (const InputError& fault) {
      if (leftOut == nullptr) throw;
      leftOut->push_back(sets[s].name + ": " + fault.what());
    }
  }
  return out;
}

double meanInRange(const DiversityCurve& curve, const std::optional<TimeRange>& range) {
  const size_t frames = curve.pairs.pairs.size();
  size_t first = 0, last = frames;
  if (range) {
    const auto at = [&](size_t t) { return static_cast<double>(t) / curve.fps; };
    while (first < frames && at(first) < range->beginS) ++first;
    while (last > first && at(last - 1) > range->endS) --last;
  }
  return 100.0 * curve.pairs.meanM(first, last);
}

LinkedGrid diversityGrid(const std::vector<DiversityCurve>& curves) {
  LinkedGrid out{.grid = render::single({})};
  render::Chart& chart = out.grid.charts.front();
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "mean distance of pairs", .unit = "cm"};
  for (const DiversityCurve& curve : curves) {
    std::vector<double> distanceCm;
    for (size_t t = 0; t < curve.pairs.pairs.size(); ++t)
      distanceCm.push_back(100.0 * curve.pairs.meanM(t));
    out.add(curve.look.line(framesInSeconds(distanceCm.size(), curve.fps), distanceCm),
            curve.look.ids);
  }
  std::vector<MotionCount> counts;
  for (const DiversityCurve& curve : curves)
    counts.push_back(
        {curve.look, curve.fps, {curve.pairs.motions.begin(), curve.pairs.motions.end()}});
  addCountStrip(out, counts);
  return out;
}

std::vector<ChartHighlight> diversityHighlights(const std::vector<DiversityCurve>& curves,
                                                const std::set<MotionId>& picked) {
  std::vector<ChartHighlight> out;
  for (const DiversityCurve& curve : curves) {
    if (!curve.look.singles(picked)) continue;
    for (size_t i = 0; i < curve.look.ids.size() && out.size() < kMostHighlights; ++i) {
      if (!picked.contains(curve.look.ids[i])) continue;
      const std::vector<float>& run = curve.motionsCm[i];
      out.push_back(curve.look.highlight(0, framesInSeconds(run.size(), curve.fps),
                                         {run.begin(), run.end()}));
    }
  }
  return out;
}

}  // namespace marey::gui

#include "gui/plots/footstep_data.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/quantile.h"
#include "motion/roles.h"
#include "report/density.h"
#include "stats/controls.h"

namespace marey::gui {
namespace {
constexpr int kDensityPoints = 120;

/// A document's names are those of one skeleton; others have feet by their own habit.
std::vector<int> feetOf(const Skeleton& skeleton, const std::string& names) {
  try {
    return stats::feetOf(skeleton, names);
  } catch (const InputError&) {
    return stats::feetOf(skeleton);
  }
}

/// Tallies of one clip, foot by foot; all clips of a set must have the feet of the first one.
std::vector<stats::FootstepTally> talliesOf(const Clip& clip, const FootstepQuery& query,
                                            const std::vector<std::string>& names) {
  const std::vector<int> feet = feetOf(*clip.skeleton, query.feet);
  if (feet.size() != names.size())
    throwInput({.path = clip.name, .item = "feet"}, fmt::format("{} feet", names.size()), "{}",
               feet.size());
  std::vector<stats::FootstepTally> out;
  for (size_t f = 0; f < feet.size(); ++f) {
    const std::string& name = clip.skeleton->names[static_cast<size_t>(feet[f])];
    if (name != names[f])
      throwInput({.path = clip.name, .item = "feet"}, fmt::format("'{}' as in its set", names[f]),
                 "'{}'", name);
    out.push_back(stats::footstepTally(clip, {.feet = {feet[f]}, .stepCmS = query.stepCmS}));
  }
  return out;
}

MotionSteps stepsOf(const MotionId& id, const Clip& clip,
                    const std::vector<stats::FootstepTally>& feet) {
  MotionSteps out{.id = id, .minutes = clip.seconds() / 60.0, .count = {}, .durationsS = {}};
  for (const stats::FootstepTally& foot : feet) {
    out.count.resize(foot.count.size());
    for (size_t k = 0; k < foot.count.size(); ++k) out.count[k] += foot.count[k];
  }
  return out;
}

void addDurations(FootstepResult& result, const std::vector<Clip>& clips, const std::string& feet) {
  if (!std::isfinite(result.all.v95CmS)) return;
  for (size_t i = 0; i < clips.size(); ++i)
    for (const auto& step :
         stats::contactIntervals(clips[i], feetOf(*clips[i].skeleton, feet), result.all.v95CmS))
      result.motions[i].durationsS.push_back(step.seconds);
}

FootstepResult resultOf(const MotionSet& set, const ClipsInRange& part, const FootstepQuery& query,
                        Progress& progress) {
  FootstepResult result{.look = lookOf(set)};
  const Skeleton& body = *part.clips.front().skeleton;
  for (const int foot : feetOf(body, query.feet))
    result.footNames.push_back(body.names[static_cast<size_t>(foot)]);
  std::vector<std::vector<stats::FootstepTally>> tallies(result.footNames.size());
  std::vector<stats::FootstepTally> all;
  for (size_t i = 0; i < part.clips.size(); ++i) {
    progress.throwIfCancelled();
    const auto feet = talliesOf(part.clips[i], query, result.footNames);
    result.motions.push_back(stepsOf(part.ids[i], part.clips[i], feet));
    result.minutes += result.motions.back().minutes;
    for (size_t f = 0; f < feet.size(); ++f) tallies[f].push_back(feet[f]);
    all.push_back(stats::footstepTally(
        part.clips[i],
        {.feet = feetOf(*part.clips[i].skeleton, query.feet), .stepCmS = query.stepCmS}));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(part.clips.size()));
  }
  const auto tolerances = stats::footstepTolerances({.feet = {}, .stepCmS = query.stepCmS});
  // Several motions along one control count as one.
  const std::vector<double> each = part.follows.empty()
                                       ? std::vector<double>(all.size(), 1.0)
                                       : stats::ControlSets(part.follows, {}).once().clips;
  for (const auto& foot : tallies) result.feet.push_back(stats::curveOf(tolerances, foot, each));
  result.all = stats::curveOf(tolerances, all, each);
  addDurations(result, part.clips, query.feet);
  return result;
}

FootstepRow rowOf(const FootstepResult& result, const std::string& foot,
                  const stats::FootstepCurve& curve) {
  return {.set = result.look.name,
          .foot = foot,
          .steps = curve.maxCount,
          .stepsPerMinute = 60.0 * curve.stepsPerS,
          .v95CmS = curve.v95CmS,
          .durationMeanS = curve.durationMeanS,
          .durationStdS = curve.durationStdS,
          .ids = result.look.ids};
}

std::vector<double> durationsOf(const FootstepResult& result) {
  std::vector<double> out;
  for (const MotionSteps& motion : result.motions)
    out.insert(out.end(), motion.durationsS.begin(), motion.durationsS.end());
  return out;
}

/// Where durations are drawn: as far as 99 % of them, so that one long stand does not flatten all.
double longestShown(const std::vector<FootstepResult>& results) {
  double longest = 0.0;
  for (const FootstepResult& result : results)
    if (const auto all = durationsOf(result); !all.empty())
      longest = std::max(longest, quantile(all, 0.99));
  return longest;
}

void addCounts(LinkedGrid& out, const FootstepResult& result, double scale) {
  const stats::FootstepCurve& curve = result.all;
  std::vector<double> y;
  for (const double count : curve.count) y.push_back(scale * count);
  out.add(result.look.line(curve.toleranceCmS, y), result.look.ids);
  const auto at = std::find_if(curve.toleranceCmS.begin(), curve.toleranceCmS.end(),
                               [&](double v) { return v >= curve.v95CmS - 1e-9; });
  if (!std::isfinite(curve.v95CmS) || at == curve.toleranceCmS.end()) return;
  out.add({.kind = render::SeriesKind::Dots,
           .name = result.look.name + ", v95",
           .colour = result.look.colour,
           .x = {*at},
           .y = {y[static_cast<size_t>(at - curve.toleranceCmS.begin())]},
           .inLegend = false},
          result.look.ids);
}

}  // namespace

std::vector<FootstepResult> footstepResults(const std::vector<MotionSet>& sets,
                                            const std::optional<TimeRange>& range,
                                            const FootstepQuery& query, Progress& progress,
                                            std::vector<std::string>* leftOut) {
  std::vector<FootstepResult> out;
  for (size_t i = 0; i < sets.size(); ++i) {
    Progress part = progress.part(static_cast<double>(i) / static_cast<double>(sets.size()),
                                  static_cast<double>(i + 1) / static_cast<double>(sets.size()));
    const ClipsInRange clips = clipsIn(sets[i], range);
    if (clips.clips.empty()) continue;
    try {
      out.push_back(resultOf(sets[i], clips, query, part));
    } catch (const InputError& fault) {
      if (leftOut == nullptr) throw;
      leftOut->push_back(sets[i].name + ": " + fault.what());
    }
  }
  return out;
}

bool perMinute(const std::vector<FootstepResult>& results) {
  return std::any_of(results.begin(), results.end(), [&](const FootstepResult& r) {
    return std::abs(r.minutes - results.front().minutes) > 0.01 * results.front().minutes;
  });
}

LinkedGrid footstepGrid(const std::vector<FootstepResult>& results) {
  LinkedGrid out{.grid = render::single({})};
  const bool scaled = perMinute(results);
  out.grid.charts.front().x = {.label = "speed tolerance", .unit = "cm/s"};
  out.grid.charts.front().y = {.label = scaled ? "footsteps per minute" : "footsteps"};
  for (const FootstepResult& result : results)
    addCounts(out, result, scaled ? 1.0 / result.minutes : 1.0);
  const double longest = longestShown(results);
  if (!(longest > 0.0)) return out;
  out.grid.columns = 2;
  out.grid.charts.push_back({});
  render::Chart& chart = out.grid.charts.back();
  chart.x = {.label = "step duration at v95", .unit = "s", .range = std::pair{0.0, longest}};
  chart.y = {.label = "density", .showTicks = false};
  chart.legend = render::LegendPlace::None;
  for (const FootstepResult& result : results) {
    const std::vector<double> durations = durationsOf(result);
    if (durations.empty()) continue;
    auto curve = report::kernelDensity(durations, 0.0, longest, kDensityPoints);
    render::Series series = result.look.line(std::move(curve.x), std::move(curve.y));
    series.kind = render::SeriesKind::Density;
    series.opacity = result.look.natural ? 0.14 : 0.10;
    out.add(std::move(series), result.look.ids);
  }
  return out;
}

std::vector<ChartHighlight> footstepHighlights(const std::vector<FootstepResult>& results,
                                               const std::set<MotionId>& picked) {
  std::vector<ChartHighlight> out;
  const bool scaled = perMinute(results);
  const double longest = longestShown(results);
  for (const FootstepResult& result : results) {
    if (!result.look.singles(picked)) continue;
    for (const MotionSteps& motion : result.motions) {
      if (!picked.contains(motion.id) || out.size() >= 2 * kMostHighlights) continue;
      const double scale = (scaled ? 1.0 : result.minutes) / motion.minutes;
      std::vector<double> y = motion.count;
      for (double& count : y) count *= scale;
      out.push_back(result.look.highlight(0, result.all.toleranceCmS, std::move(y)));
      if (motion.durationsS.empty()) continue;
      auto curve = report::kernelDensity(motion.durationsS, 0.0, longest, kDensityPoints);
      out.push_back(result.look.highlight(1, std::move(curve.x), std::move(curve.y)));
    }
  }
  return out;
}

std::vector<FootstepRow> footstepRows(const std::vector<FootstepResult>& results) {
  std::vector<FootstepRow> rows;
  for (const FootstepResult& result : results) {
    rows.push_back(rowOf(result, "all", result.all));
    for (size_t f = 0; f < result.feet.size(); ++f)
      rows.push_back(rowOf(result, result.footNames[f], result.feet[f]));
  }
  return rows;
}

}  // namespace marey::gui

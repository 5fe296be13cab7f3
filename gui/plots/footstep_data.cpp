#include "plots/footstep_data.h"

#include <algorithm>
#include <cmath>

namespace marey::gui {
namespace {

FootstepResult resultOf(const MotionSet& set, const std::vector<Clip>& clips,
                        const stats::FootstepOptions& options, Progress& progress) {
  FootstepResult result{.look = lookOf(set)};
  const std::vector<double> tolerances = stats::footstepTolerances(options);
  std::vector<stats::FootstepTally> all;
  for (size_t f = 0; f < options.feet.size(); ++f) {
    stats::FootstepOptions one = options;
    one.feet = {options.feet[f]};
    std::vector<stats::FootstepTally> tallies;
    for (const Clip& clip : clips) {
      progress.throwIfCancelled();
      tallies.push_back(stats::footstepTally(clip, one));
    }
    const std::vector<int> once(tallies.size(), 1);
    result.feet.push_back(stats::curveOf(tolerances, tallies, once));
    all.insert(all.end(), tallies.begin(), tallies.end());
    progress.report(static_cast<double>(f + 1) / static_cast<double>(options.feet.size()));
  }
  result.all = stats::curveOf(tolerances, all, std::vector<int>(all.size(), 1));
  for (const Clip& clip : clips) result.minutes += clip.seconds() / 60.0;
  return result;
}

FootstepRow rowOf(const FootstepResult& result, const std::string& foot,
                  const stats::FootstepCurve& curve) {
  const auto steps = static_cast<double>(curve.maxCount);
  return {.set = result.look.name,
          .foot = foot,
          .steps = steps,
          .stepsPerMinute = steps / result.minutes,
          .v95CmS = curve.v95CmS,
          .durationMeanS = curve.durationMeanS,
          .durationStdS = curve.durationStdS,
          .ids = result.look.ids};
}

}  // namespace

std::vector<FootstepResult> footstepResults(const std::vector<MotionSet>& sets,
                                            const std::optional<TimeRange>& range,
                                            const stats::FootstepOptions& options,
                                            Progress& progress) {
  std::vector<FootstepResult> out;
  for (size_t i = 0; i < sets.size(); ++i) {
    Progress part = progress.part(static_cast<double>(i) / static_cast<double>(sets.size()),
                                  static_cast<double>(i + 1) / static_cast<double>(sets.size()));
    const std::vector<Clip> clips = clipsIn(sets[i], range).clips;
    if (!clips.empty()) out.push_back(resultOf(sets[i], clips, options, part));
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
  render::Chart& chart = out.grid.charts.front();
  const bool scaled = perMinute(results);
  chart.x = {.label = "speed tolerance", .unit = "cm/s"};
  chart.y = {.label = scaled ? "footsteps per minute" : "footsteps"};
  for (const FootstepResult& result : results) {
    const stats::FootstepCurve& curve = result.all;
    const double scale = scaled ? 1.0 / result.minutes : 1.0;
    std::vector<double> y;
    for (const long count : curve.count) y.push_back(scale * static_cast<double>(count));
    out.add(result.look.line(curve.toleranceCmS, y), result.look.ids);
    const auto at = std::find_if(curve.toleranceCmS.begin(), curve.toleranceCmS.end(),
                                 [&](double v) { return v >= curve.v95CmS - 1e-9; });
    if (!std::isfinite(curve.v95CmS) || at == curve.toleranceCmS.end()) continue;
    out.add({.kind = render::SeriesKind::Dots,
             .name = result.look.name + ", v95",
             .colour = result.look.colour,
             .x = {*at},
             .y = {y[static_cast<size_t>(at - curve.toleranceCmS.begin())]},
             .inLegend = false},
            result.look.ids);
  }
  return out;
}

std::vector<FootstepRow> footstepRows(const std::vector<FootstepResult>& results,
                                      const std::vector<std::string>& footNames) {
  std::vector<FootstepRow> rows;
  for (const FootstepResult& result : results) {
    rows.push_back(rowOf(result, "all", result.all));
    for (size_t f = 0; f < result.feet.size(); ++f)
      rows.push_back(rowOf(result, f < footNames.size() ? footNames[f] : "", result.feet[f]));
  }
  return rows;
}

}  // namespace marey::gui

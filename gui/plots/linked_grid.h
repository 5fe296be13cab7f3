// A chart whose curves know the motions that they were made of.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "gui/plots/chart_hit.h"
#include "gui/plots/motion_sets.h"

namespace marey::gui {

struct LinkedGrid {
  render::ChartGrid grid;
  std::map<CurveRef, std::vector<MotionId>> motions;

  /// Adds a series to the last chart.
  void add(render::Series series, const std::vector<MotionId>& ids = {}) {
    addTo(static_cast<int>(grid.charts.size()) - 1, std::move(series), ids);
  }
  void addTo(int index, render::Series series, const std::vector<MotionId>& ids = {}) {
    render::Chart& chart = grid.charts[static_cast<size_t>(index)];
    const CurveRef curve{index, static_cast<int>(chart.series.size()), -1};
    // The lines of a cloud are one motion each.
    for (size_t i = 0; series.cloud && i < ids.size(); ++i)
      motions[{curve.chart, curve.series, static_cast<int>(i)}] = {ids[i]};
    if (!series.cloud && !ids.empty()) motions[curve] = ids;
    chart.series.push_back(std::move(series));
  }
};

/// More curves over each other than this show nothing.
inline constexpr size_t kMostHighlights = 24;

/// How a set is drawn everywhere.
struct SetLook {
  std::string name;
  render::Colour colour;
  bool dashed = false, natural = false;
  std::vector<MotionId> ids;

  /// Whether one motion is to be shown by a curve of its own: it is picked, but not all of the set,
  /// whose own curve lights up then.
  bool singles(const std::set<MotionId>& picked) const {
    return !std::all_of(ids.begin(), ids.end(),
                        [&](const MotionId& id) { return picked.contains(id); });
  }
  ChartHighlight highlight(int chart, std::vector<double> x, std::vector<double> y) const {
    return {.chart = chart, .x = std::move(x), .y = std::move(y), .colour = colour};
  }
  render::Series line(std::vector<double> x, std::vector<double> y) const {
    return {.kind = render::SeriesKind::Line,
            .name = name,
            .colour = colour,
            .x = std::move(x),
            .y = std::move(y),
            .dashed = dashed};
  }
  render::Series band(std::vector<double> x, std::vector<double> low,
                      std::vector<double> high) const {
    return {.kind = render::SeriesKind::Band,
            .colour = colour,
            .x = std::move(x),
            .low = std::move(low),
            .high = std::move(high),
            .opacity = 0.16,
            .inLegend = false};
  }
};
inline SetLook lookOf(const MotionSet& set) {
  return {set.name, set.colour, set.dashed, set.natural, set.ids};
}

}  // namespace marey::gui

#include "gui/plots/count_strip.h"

#include <algorithm>

namespace marey::gui {
namespace {
/// Of the height of a plot above it.
constexpr double kStripShare = 0.35;

/// Not counting the frames before the first value, which are history.
bool changes(const MotionCount& count) {
  const auto first = std::find_if(count.goingOn.begin(), count.goingOn.end(),
                                  [](int motions) { return motions > 0; });
  return first != count.goingOn.end() &&
         std::any_of(first, count.goingOn.end(), [&](int motions) { return motions != *first; });
}

/// A line with steps where the number changes.
render::Series stepsOf(const MotionCount& count) {
  std::vector<double> x, y;
  for (size_t t = 0; t < count.goingOn.size(); ++t) {
    const auto motions = static_cast<double>(count.goingOn[t]);
    const double time = static_cast<double>(t) / count.fps;
    const bool last = t + 1 == count.goingOn.size();
    if (!y.empty() && motions == y.back() && !last) continue;
    if (!y.empty() && motions != y.back()) {
      x.push_back(time);
      y.push_back(y.back());
    }
    x.push_back(time);
    y.push_back(motions);
  }
  render::Series series = count.look.line(std::move(x), std::move(y));
  series.inLegend = false;
  return series;
}
}  // namespace

void addCountStrip(LinkedGrid& grid, const std::vector<MotionCount>& counts) {
  if (std::none_of(counts.begin(), counts.end(), changes)) return;
  grid.grid.rowShares.assign(grid.grid.charts.size(), 1.0);
  grid.grid.rowShares.push_back(kStripShare);
  grid.grid.columns = 1;
  grid.grid.shareX = true;
  int most = 1;
  for (const MotionCount& count : counts)
    for (const int motions : count.goingOn) most = std::max(most, motions);
  grid.grid.charts.push_back({});
  render::Chart& chart = grid.grid.charts.back();
  chart.x = grid.grid.charts.front().x;
  chart.y = {.label = "motions", .range = std::pair{0.0, 1.08 * most}};
  for (const MotionCount& count : counts)
    if (!count.goingOn.empty()) grid.add(stepsOf(count), count.look.ids);
}

}  // namespace marey::gui

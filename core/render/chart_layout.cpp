#include <algorithm>

#include "render/chart_frame.h"
#include "render/chart_private.h"

namespace marey::render {

namespace {
constexpr double gap = 16.0;

struct Margins {
  double left = 0.0, right = 8.0, top = 0.0, bottom = 0.0;
};

/// The grid's geometry: the same margins for every cell, so that plots line up.
struct Layout {
  Box area;
  Margins margins;
  int columns = 1, rows = 1;
  bool innerX = true, innerY = true;  ///< do inner cells carry labels too?

  CellLook look(int index, int count) const {
    const int column = index % columns;
    return {.xLabels = innerX || index + columns >= count, .yLabels = innerY || column == 0};
  }
  Box cell(int index) const {
    const double outerLeft = innerY ? 0.0 : margins.left - 6.0;
    const double outerBottom = innerX ? 0.0 : margins.bottom - 8.0;
    const double width = (area.width() - outerLeft - (columns - 1) * gap) / columns;
    const double height = (area.height() - outerBottom - (rows - 1) * gap) / rows;
    const int row = index / columns;
    const double left = area.left + outerLeft + (index % columns) * (width + gap);
    const double top = area.top + row * (height + gap);
    return {left - outerLeft, top, left + width, top + height + outerBottom};
  }
  Box plot(int index) const {
    const Box c = cell(index);
    return {c.left + margins.left, c.top + margins.top, c.right - margins.right,
            c.bottom - margins.bottom};
  }
};

double widestLabel(Drawing& drawing, const Ticks& ticks) {
  double width = 0.0;
  for (const std::string& label : ticks.labels) {
    width = std::max(width, drawing.textWidth(label, tickStyle()));
  }
  return width;
}

Margins marginsOf(Drawing& drawing, const Chart& chart, const Range& y, double height) {
  Margins m;
  m.top = chart.title.empty() ? 8.0 : 24.0;
  m.bottom = (chart.x.showTicks ? 20.0 : 6.0) + (chart.x.label.empty() ? 0.0 : 18.0);
  const Ticks ticks = ticksOf(chart.y, y, height - m.top - m.bottom, 36.0);
  m.left = (chart.y.showTicks ? widestLabel(drawing, ticks) + 8.0 : 6.0) +
           (chart.y.label.empty() ? 0.0 : 20.0);
  m.right = std::max(10.0, directLabelWidth(drawing, chart));
  return m;
}

Layout layoutOf(Drawing& drawing, const ChartGrid& grid, const Box& area) {
  Layout layout;
  layout.area = area;
  const int count = static_cast<int>(grid.charts.size());
  layout.columns = std::clamp(grid.columns, 1, count);
  layout.rows = (count + layout.columns - 1) / layout.columns;
  layout.innerX = !grid.shareX || layout.rows == 1;
  layout.innerY = !grid.shareY || layout.columns == 1;
  for (const Chart& chart : grid.charts) {
    const Range y = grid.shareY ? joinedRange(grid.charts, 'y') : rangeOf(chart, 'y');
    const Margins m = marginsOf(drawing, chart, y, area.height() / layout.rows);
    layout.margins = {std::max(layout.margins.left, m.left),
                      std::max(layout.margins.right, m.right), std::max(layout.margins.top, m.top),
                      std::max(layout.margins.bottom, m.bottom)};
  }
  return layout;
}
}  // namespace

Ticks ticksOf(const Axis& axis, const Range& range, double pixels, double pixelsPerTick) {
  if (axis.categories.empty()) {
    return niceTicks(range.low, range.high, std::max(2, static_cast<int>(pixels / pixelsPerTick)));
  }
  Ticks ticks;
  for (size_t i = 0; i < axis.categories.size(); ++i) {
    ticks.values.push_back(static_cast<double>(i) + 0.5);
    ticks.labels.push_back(axis.categories[i]);
  }
  return ticks;
}

TextStyle tickStyle() {
  return {.size = 12.0, .colour = grey(0.36)};
}

PlacedGrid placed(Drawing& drawing, const ChartGrid& grid, const ChartSize& size) {
  PlacedGrid out;
  Box area{6.0, 6.0, size.width - 6.0, size.height - 4.0};
  if (!grid.title.empty()) area.top += 26.0;
  out.legend = legendItems(grid.charts);
  // A single name says nothing that the title does not.
  if (out.legend.size() < 2) out.legend.clear();
  out.legendBox = area;
  if (!out.legend.empty()) area.top += legendHeight(drawing, out.legend, area.width());
  if (grid.charts.empty()) return out;
  const Layout layout = layoutOf(drawing, grid, area);
  const int count = static_cast<int>(grid.charts.size());
  for (int i = 0; i < count; ++i) {
    const Chart& chart = grid.charts[static_cast<size_t>(i)];
    const Mapping map{.plot = layout.plot(i),
                      .x = grid.shareX ? joinedRange(grid.charts, 'x') : rangeOf(chart, 'x'),
                      .y = grid.shareY ? joinedRange(grid.charts, 'y') : rangeOf(chart, 'y'),
                      .rowsFromTop = !chart.y.categories.empty()};
    out.cells.push_back({.cell = layout.cell(i), .map = map, .look = layout.look(i, count)});
  }
  return out;
}

std::vector<ChartFrame> framesOf(const ChartGrid& grid, const ChartSize& size) {
  for (const Chart& chart : grid.charts) checkChart(chart);
  // Widths of text are the same on every surface: one pixel is enough to measure them.
  Canvas canvas(1, 1);
  Drawing drawing(canvas.context());
  std::vector<ChartFrame> frames;
  for (const PlacedCell& cell : placed(drawing, grid, size).cells) {
    const Mapping& map = cell.map;
    frames.push_back({.left = map.plot.left,
                      .top = map.plot.top,
                      .right = map.plot.right,
                      .bottom = map.plot.bottom,
                      .xLow = map.x.low,
                      .xHigh = map.x.high,
                      .yLow = map.y.low,
                      .yHigh = map.y.high,
                      .rowsFromTop = map.rowsFromTop});
  }
  return frames;
}

double ChartFrame::pixelX(double dataX) const {
  return left + (dataX - xLow) / (xHigh - xLow) * (right - left);
}

double ChartFrame::pixelY(double dataY) const {
  const double share = (dataY - yLow) / (yHigh - yLow);
  return rowsFromTop ? top + share * (bottom - top) : bottom - share * (bottom - top);
}

double ChartFrame::dataX(double pixelX) const {
  return xLow + (pixelX - left) / (right - left) * (xHigh - xLow);
}

double ChartFrame::dataY(double pixelY) const {
  const double share = rowsFromTop ? pixelY - top : bottom - pixelY;
  return yLow + share / (bottom - top) * (yHigh - yLow);
}

}  // namespace marey::render

#include <algorithm>
#include <numeric>

#include "render/chart/chart_frame.h"
#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
constexpr double gap = 16.0;
/// Smaller plots cannot be read.
constexpr double leastPlotWidth = 84.0, leastPlotHeight = 46.0;
/// Of a cell's width, for names at the left.
constexpr double mostLabelShare = 0.4;

struct Margins {
  double left = 0.0, right = 8.0, top = 0.0, bottom = 0.0;
};

/// What stands around the plots; less where the page is too small for all.
enum class Around { All, NoTitles, Nothing };

/// The grid's geometry: the same margins for every cell, so that plots line up.
struct Layout {
  Box area;
  Margins margins;
  int columns = 1, rows = 1;
  bool innerX = true, innerY = true;  ///< do inner cells carry labels too?
  Around around = Around::All;
  std::vector<double> shares;  ///< of every row; their sum is 1

  double outerLeft() const { return innerY ? 0.0 : std::max(0.0, margins.left - 6.0); }
  double outerBottom() const { return innerX ? 0.0 : std::max(0.0, margins.bottom - 8.0); }
  double innerBottom() const { return margins.bottom - outerBottom(); }
  double cellWidth() const { return (area.width() - outerLeft() - (columns - 1) * gap) / columns; }
  /// What is left for the plots of all rows together.
  double plotHeights() const {
    return area.height() - outerBottom() - (rows - 1) * gap - rows * (margins.top + innerBottom());
  }
  CellLook look(int index, int count) const {
    const int column = index % columns;
    const bool labels = around != Around::Nothing;
    return {.xLabels = labels && (innerX || index + columns >= count),
            .yLabels = labels && (innerY || column == 0),
            .axisTitles = around == Around::All};
  }
  Box cell(int index) const {
    const int row = index / columns;
    const double left = area.left + outerLeft() + (index % columns) * (cellWidth() + gap);
    double top = area.top;
    for (int r = 0; r < row; ++r) top += rowHeight(r) + gap;
    return {left - outerLeft(), top, left + cellWidth(), top + rowHeight(row) + outerBottom()};
  }
  /// Never turned inside out, however small the page is.
  Box plot(int index) const {
    const Box c = cell(index);
    const double left = c.left + margins.left, top = c.top + margins.top;
    return {left, top, std::max(left + 1.0, c.right - margins.right),
            std::max(top + 1.0, c.bottom - margins.bottom)};
  }
  /// 1: as large as is needed, below: so much too small.
  double readable() const {
    const double least = *std::min_element(shares.begin(), shares.end());
    const double width = cellWidth() + outerLeft() - margins.left - margins.right;
    const double even = plotHeights() * std::max(least, 0.5 / static_cast<double>(rows));
    return std::min({1.0, width / leastPlotWidth, even / leastPlotHeight});
  }

 private:
  double rowHeight(int row) const {
    return margins.top + innerBottom() + plotHeights() * shares[static_cast<size_t>(row)];
  }
};

double widestLabel(Drawing& drawing, const Ticks& ticks) {
  double width = 0.0;
  for (const std::string& label : ticks.labels) {
    width = std::max(width, drawing.textWidth(label, tickStyle()));
  }
  return width;
}

Margins marginsOf(Drawing& drawing, const Chart& chart, const Range& y, const Layout& layout) {
  Margins m;
  m.top = chart.title.empty() ? 8.0 : 24.0;
  m.right = std::max(10.0, directLabelWidth(drawing, chart));
  m.bottom = m.left = 6.0;
  if (layout.around == Around::Nothing) return m;
  const bool titles = layout.around == Around::All;
  m.bottom = (chart.x.showTicks ? 20.0 : 6.0) + (chart.x.label.empty() || !titles ? 0.0 : 18.0);
  const double height = layout.area.height() / layout.rows - m.top - m.bottom;
  const double most = mostLabelShare * layout.area.width() / layout.columns;
  const Ticks ticks = ticksOf(chart.y, y, height, 36.0);
  m.left = (chart.y.showTicks ? std::min(most, widestLabel(drawing, ticks)) + 8.0 : 6.0) +
           (chart.y.label.empty() || !titles ? 0.0 : 20.0);
  return m;
}

std::vector<double> sharesOf(const ChartGrid& grid, int rows) {
  std::vector<double> shares = grid.rowShares;
  if (shares.size() != static_cast<size_t>(rows)) shares.assign(static_cast<size_t>(rows), 1.0);
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

Layout layoutWith(Drawing& drawing, const ChartGrid& grid, const Box& area, int columns,
                  Around around) {
  Layout layout{.area = area, .around = around};
  const int count = static_cast<int>(grid.charts.size());
  layout.columns = std::clamp(columns, 1, count);
  layout.rows = (count + layout.columns - 1) / layout.columns;
  layout.innerX = !grid.shareX || layout.rows == 1;
  layout.innerY = !grid.shareY || layout.columns == 1;
  layout.shares = sharesOf(grid, layout.rows);
  for (const Chart& chart : grid.charts) {
    const Range y = grid.shareY ? joinedRange(grid.charts, 'y') : rangeOf(chart, 'y');
    const Margins m = marginsOf(drawing, chart, y, layout);
    layout.margins = {std::max(layout.margins.left, m.left),
                      std::max(layout.margins.right, m.right), std::max(layout.margins.top, m.top),
                      std::max(layout.margins.bottom, m.bottom)};
  }
  return layout;
}

/// The grid's own columns where that can be read; else others, and then less around the plots.
Layout layoutOf(Drawing& drawing, const ChartGrid& grid, const Box& area) {
  Layout best;
  double readable = 0.0;
  for (const Around around : {Around::All, Around::NoTitles, Around::Nothing}) {
    std::vector<int> columns{grid.columns};
    for (int c = 1; grid.rowShares.empty() && c <= static_cast<int>(grid.charts.size()); ++c)
      columns.push_back(c);
    for (const int c : columns) {
      Layout layout = layoutWith(drawing, grid, area, c, around);
      const double now = layout.readable();
      if (!best.shares.empty() && now <= readable) continue;
      readable = now;
      best = std::move(layout);
      if (readable >= 1.0) return best;
    }
  }
  return best;
}

/// What is left of the page below title and legend.
Box areaOf(Drawing& drawing, const ChartGrid& grid, const ChartSize& size, PlacedGrid& out) {
  Box area{6.0, 6.0, size.width - 6.0, size.height - 4.0};
  if (!grid.title.empty()) area.top += 26.0;
  out.legend = legendItems(grid.charts);
  // A single name says nothing that the title does not.
  if (out.legend.size() < 2) out.legend.clear();
  out.legendBox = area;
  if (!out.legend.empty()) area.top += legendHeight(drawing, out.legend, area.width());
  return area;
}

/// The tallest title beside the plots, which stands upright.
double tallestTitle(Drawing& drawing, const ChartGrid& grid) {
  double tallest = 0.0;
  for (const Chart& chart : grid.charts)
    if (!chart.y.label.empty())
      tallest = std::max(tallest, drawing.textWidth(axisTitle(chart.y), axisTitleStyle()));
  return tallest;
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
  const Box area = areaOf(drawing, grid, size, out);
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

double leastHeight(const ChartGrid& grid, double width) {
  constexpr double ample = 4000.0;
  if (grid.charts.empty()) return 0.0;
  Canvas canvas(1, 1);
  Drawing drawing(canvas.context());
  PlacedGrid page;
  const Box area = areaOf(drawing, grid, {width, ample}, page);
  // On a page as high as one likes only the width decides about columns.
  const Layout layout = layoutOf(drawing, grid, area);
  const double around = ample - layout.plotHeights();
  const double least = *std::min_element(layout.shares.begin(), layout.shares.end());
  const double largest = *std::max_element(layout.shares.begin(), layout.shares.end());
  const double plots = leastPlotHeight / std::max(least, 0.5 / static_cast<double>(layout.rows));
  const double beside = tallestTitle(drawing, grid) - layout.margins.top - layout.margins.bottom;
  return around + std::max(plots, beside / largest);
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

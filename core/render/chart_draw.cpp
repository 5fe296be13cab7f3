#include <algorithm>
#include <cmath>

#include "render/chart_private.h"

namespace marey::render {

namespace {
const TextStyle tickStyle{.size = 12.0, .colour = grey(0.36)};
const TextStyle labelStyle{.size = 12.0, .colour = grey(0.2), .align = Align::Centre};
const TextStyle chartTitleStyle{.size = 13.0, .colour = grey(0.13), .bold = true};
const TextStyle gridTitleStyle{.size = 15.0, .colour = grey(0.1), .bold = true};
constexpr double gap = 16.0;

std::string axisTitle(const Axis& axis) {
  if (axis.unit.empty()) return axis.label;
  return axis.label + " [" + axis.unit + "]";
}

std::vector<Point> points(const Series& s, const std::vector<double>& y, const Mapping& map) {
  std::vector<Point> result;
  for (size_t i = 0; i < s.x.size(); ++i) result.push_back(map(s.x[i], y[i]));
  return result;
}

void drawBand(Drawing& drawing, const Series& s, const Mapping& map) {
  std::vector<Point> outline = points(s, s.low, map);
  const std::vector<Point> top = points(s, s.high, map);
  outline.insert(outline.end(), top.rbegin(), top.rend());
  drawing.polygon(outline, withOpacity(s.colour, s.opacity));
}

void drawDensity(Drawing& drawing, const Series& s, const Mapping& map) {
  if (s.x.empty()) return;
  const std::vector<Point> curve = points(s, s.y, map);
  std::vector<Point> outline = curve;
  outline.push_back(map(s.x.back(), 0.0));
  outline.push_back(map(s.x.front(), 0.0));
  drawing.polygon(outline, withOpacity(s.colour, s.opacity));
  drawing.polyline(curve, s.colour, s.width, s.dashed);
}

void drawBars(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.x.size(); ++i) {
    const Point a = map(s.x[i] - s.width / 2, 0.0), b = map(s.x[i] + s.width / 2, s.y[i]);
    drawing.fillBox({a.x, std::min(a.y, b.y), b.x, std::max(a.y, b.y)},
                    withOpacity(s.colour, s.opacity));
  }
}

void drawIntervals(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.y.size(); ++i) {
    const Point a = map(s.low[i], s.y[i] - s.width / 2), b = map(s.high[i], s.y[i] + s.width / 2);
    drawing.fillBox({a.x, std::min(a.y, b.y), b.x, std::max(a.y, b.y)},
                    withOpacity(s.colour, s.opacity));
  }
}

void drawDots(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.low.size(); ++i) {
    const bool alongX = s.errorAxis == 'x';
    const Point a = alongX ? map(s.low[i], s.y[i]) : map(s.x[i], s.low[i]);
    const Point b = alongX ? map(s.high[i], s.y[i]) : map(s.x[i], s.high[i]);
    drawing.line(a, b, s.colour, 2.0);
  }
  for (size_t i = 0; i < s.x.size(); ++i) {
    drawing.disc(map(s.x[i], s.y[i]), 5.5, {1, 1, 1, 1});
    drawing.disc(map(s.x[i], s.y[i]), 4.2, s.colour);
  }
}

void drawRule(Drawing& drawing, const Series& s, const Mapping& map) {
  TextStyle style{.size = 12.0, .colour = mix(s.colour, grey(0.0), 0.2), .halo = true};
  if (s.kind == SeriesKind::HorizontalRule) {
    const double y = map(map.x.low, s.y.front()).y;
    drawing.line({map.plot.left, y}, {map.plot.right, y}, s.colour, s.width, s.dashed);
    style.align = Align::Right;
    const bool below = y - map.plot.top < 16.0;
    if (s.inLegend) drawing.text(s.name, {map.plot.right - 4.0, below ? y + 14.0 : y - 5.0}, style);
    return;
  }
  const double x = map(s.x.front(), map.y.low).x;
  drawing.line({x, map.plot.top}, {x, map.plot.bottom}, s.colour, s.width, s.dashed);
  style.align = x > map.plot.left + 0.6 * map.plot.width() ? Align::Right : Align::Left;
  const double shift = style.align == Align::Right ? -5.0 : 5.0;
  if (s.inLegend) drawing.text(s.name, {x + shift, map.plot.top + 13.0}, style);
}

/// What a cell shows besides its plot.
struct CellLook {
  bool xLabels = true, yLabels = true;
};

struct Margins {
  double left = 0.0, right = 8.0, top = 0.0, bottom = 0.0;
};

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

double widestLabel(Drawing& drawing, const Ticks& ticks) {
  double width = 0.0;
  for (const std::string& label : ticks.labels) {
    width = std::max(width, drawing.textWidth(label, tickStyle));
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

void drawAxes(Drawing& drawing, const Chart& chart, const Mapping& map, const CellLook& look) {
  const Box& plot = map.plot;
  const Colour gridColour = grey(0.91);
  if (chart.y.showTicks) {
    const Ticks ticks = ticksOf(chart.y, map.y, plot.height(), 36.0);
    for (size_t i = 0; i < ticks.values.size(); ++i) {
      const double y = map(map.x.low, ticks.values[i]).y;
      drawing.line({plot.left, y}, {plot.right, y}, gridColour, 1.0);
      TextStyle style = tickStyle;
      style.align = Align::Right;
      if (look.yLabels) drawing.text(ticks.labels[i], {plot.left - 6.0, y + 4.2}, style);
    }
  }
  if (chart.x.showTicks) {
    const Ticks ticks = ticksOf(chart.x, map.x, plot.width(), 64.0);
    for (size_t i = 0; i < ticks.values.size(); ++i) {
      const double x = map(ticks.values[i], map.y.low).x;
      if (chart.x.categories.empty()) {
        drawing.line({x, plot.top}, {x, plot.bottom}, gridColour, 1.0);
        drawing.line({x, plot.bottom}, {x, plot.bottom + 4.0}, grey(0.6), 1.0);
      }
      TextStyle style = tickStyle;
      style.align = Align::Centre;
      if (look.xLabels) drawing.text(ticks.labels[i], {x, plot.bottom + 16.5}, style);
    }
  }
}

void drawAxisTitles(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
                    const CellLook& look) {
  const Box& plot = map.plot;
  if (look.xLabels && !chart.x.label.empty()) {
    drawing.text(axisTitle(chart.x), {(plot.left + plot.right) / 2, plot.bottom + 35.0},
                 labelStyle);
  }
  if (look.yLabels && !chart.y.label.empty()) {
    TextStyle style = labelStyle;
    style.turn = -M_PI / 2;
    drawing.text(axisTitle(chart.y), {cell.left + 12.0, (plot.top + plot.bottom) / 2}, style);
  }
  if (!chart.title.empty()) {
    drawing.text(chart.title, {plot.left, plot.top - 9.0}, chartTitleStyle);
  }
}

void drawCell(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
              const CellLook& look) {
  drawAxes(drawing, chart, map, look);
  drawing.clipTo({map.plot.left - 1, map.plot.top - 1, map.plot.right + 1, map.plot.bottom + 1});
  for (const Series& s : chart.series) drawSeries(drawing, s, map);
  drawing.endClip();
  drawing.line({map.plot.left, map.plot.bottom}, {map.plot.right, map.plot.bottom}, grey(0.45),
               1.0);
  if (chart.legend == LegendPlace::Direct) drawDirectLabels(drawing, chart, map);
  drawAxisTitles(drawing, chart, cell, map, look);
}

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

void drawSeries(Drawing& drawing, const Series& s, const Mapping& map) {
  switch (s.kind) {
    case SeriesKind::Line:
      drawing.polyline(points(s, s.y, map), s.colour, s.width, s.dashed);
      break;
    case SeriesKind::Band:
      drawBand(drawing, s, map);
      break;
    case SeriesKind::Density:
      drawDensity(drawing, s, map);
      break;
    case SeriesKind::Bars:
      drawBars(drawing, s, map);
      break;
    case SeriesKind::Intervals:
      drawIntervals(drawing, s, map);
      break;
    case SeriesKind::Dots:
      drawDots(drawing, s, map);
      break;
    case SeriesKind::HorizontalRule:
    case SeriesKind::VerticalRule:
      drawRule(drawing, s, map);
      break;
  }
}

void drawGrid(Drawing& drawing, const ChartGrid& grid, const ChartSize& size) {
  drawing.fillBox({0, 0, size.width, size.height}, {1, 1, 1, 1});
  Box area{6.0, 6.0, size.width - 6.0, size.height - 4.0};
  if (!grid.title.empty()) {
    drawing.text(grid.title, {area.left, area.top + 14.0}, gridTitleStyle);
    area.top += 26.0;
  }
  const std::vector<LegendItem> items = legendItems(grid.charts);
  if (items.size() > 1) area.top += drawLegend(drawing, items, area);
  if (grid.charts.empty()) return;
  const Layout layout = layoutOf(drawing, grid, area);
  const int count = static_cast<int>(grid.charts.size());
  for (int i = 0; i < count; ++i) {
    const Chart& chart = grid.charts[static_cast<size_t>(i)];
    const Mapping map{.plot = layout.plot(i),
                      .x = grid.shareX ? joinedRange(grid.charts, 'x') : rangeOf(chart, 'x'),
                      .y = grid.shareY ? joinedRange(grid.charts, 'y') : rangeOf(chart, 'y'),
                      .rowsFromTop = !chart.y.categories.empty()};
    drawCell(drawing, chart, layout.cell(i), map, layout.look(i, count));
  }
}

}  // namespace marey::render

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
const TextStyle gridTitleStyle{.size = 15.0, .colour = grey(0.1), .bold = true};

const Colour gridColour = grey(0.91);
/// Between labels of ticks.
constexpr double tickApart = 3.0;

/// Draws a label unless it would meet the one before, and keeps it in mind.
void drawTick(Drawing& drawing, const std::string& text, Point at, const TextStyle& style,
              std::optional<Box>& before) {
  Box box = boxOf(drawing, text, at, style);
  if (before && overlap(box, *before)) return;
  drawing.text(text, at, style);
  before = Box{box.left - tickApart, box.top, box.right + tickApart, box.bottom};
}

void drawYAxis(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
               const CellLook& look) {
  const Box& plot = map.plot;
  const Ticks ticks = ticksOf(chart.y, map.y, plot.height(), 36.0);
  const double title = chart.y.label.empty() || !look.axisTitles ? 0.0 : 20.0;
  TextStyle style = tickStyle();
  style.align = Align::Right;
  std::optional<Box> before;
  for (size_t i = 0; i < ticks.values.size(); ++i) {
    const double y = map(map.x.low, ticks.values[i]).y;
    drawing.line({plot.left, y}, {plot.right, y}, gridColour, 1.0);
    if (!look.yLabels) continue;
    const std::string label =
        elided(drawing, ticks.labels[i], style, plot.left - 6.0 - cell.left - title);
    drawTick(drawing, label, {plot.left - 6.0, y + 4.2}, style, before);
  }
}

void drawXAxis(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
               const CellLook& look) {
  const Box& plot = map.plot;
  const Ticks ticks = ticksOf(chart.x, map.x, plot.width(), 64.0);
  TextStyle style = tickStyle();
  style.align = Align::Centre;
  std::optional<Box> before;
  for (size_t i = 0; i < ticks.values.size(); ++i) {
    const double x = map(ticks.values[i], map.y.low).x;
    if (chart.x.categories.empty()) {
      drawing.line({x, plot.top}, {x, plot.bottom}, gridColour, 1.0);
      drawing.line({x, plot.bottom}, {x, plot.bottom + 4.0}, grey(0.6), 1.0);
    }
    if (!look.xLabels) continue;
    // The last one may reach beyond the plot, not beyond the page.
    const double half = drawing.textWidth(ticks.labels[i], style) / 2;
    const double at = std::max(std::min(x, cell.right + 5.0 - half), cell.left + half);
    drawTick(drawing, ticks.labels[i], {at, plot.bottom + 16.5}, style, before);
  }
}

void drawAxes(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
              const CellLook& look) {
  if (chart.y.showTicks) drawYAxis(drawing, chart, cell, map, look);
  if (chart.x.showTicks) drawXAxis(drawing, chart, cell, map, look);
}

/// The middle of something that long, near `wanted` and inside the two ends.
double middleInside(double wanted, double length, double low, double high) {
  return std::max(low + length / 2, std::min(wanted, high - length / 2));
}

void drawAxisTitles(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
                    const CellLook& look) {
  const Box& plot = map.plot;
  TextStyle style = axisTitleStyle();
  if (look.axisTitles && look.xLabels && !chart.x.label.empty()) {
    const std::string title = elided(drawing, axisTitle(chart.x), style, cell.width());
    const double x = middleInside((plot.left + plot.right) / 2, drawing.textWidth(title, style),
                                  cell.left, cell.right);
    drawing.text(title, {x, plot.bottom + 35.0}, style);
  }
  if (look.axisTitles && look.yLabels && !chart.y.label.empty()) {
    const std::string title = elided(drawing, axisTitle(chart.y), style, cell.height());
    const double y = middleInside((plot.top + plot.bottom) / 2, drawing.textWidth(title, style),
                                  cell.top, cell.bottom);
    style.turn = -M_PI / 2;
    drawing.text(title, {cell.left + 12.0, y}, style);
  }
  if (!chart.title.empty())
    drawing.text(elided(drawing, chart.title, chartTitleStyle(), cell.right - plot.left),
                 {plot.left, plot.top - 9.0}, chartTitleStyle());
}

void drawCell(Drawing& drawing, const Chart& chart, const Box& cell, const Mapping& map,
              const CellLook& look) {
  drawAxes(drawing, chart, cell, map, look);
  drawing.clipTo({map.plot.left - 1, map.plot.top - 1, map.plot.right + 1, map.plot.bottom + 1});
  for (const Series& s : chart.series) drawSeries(drawing, s, map);
  drawing.endClip();
  for (const PlacedText& label : ruleLabels(drawing, chart, map))
    drawing.text(label.text, label.at, label.style);
  drawing.line({map.plot.left, map.plot.bottom}, {map.plot.right, map.plot.bottom}, grey(0.45),
               1.0);
  if (chart.legend == LegendPlace::Direct) drawDirectLabels(drawing, chart, map);
  drawAxisTitles(drawing, chart, cell, map, look);
}

}  // namespace

std::string axisTitle(const Axis& axis) {
  if (axis.unit.empty()) return axis.label;
  return axis.label + " [" + axis.unit + "]";
}

TextStyle axisTitleStyle() {
  return {.size = 12.0, .colour = grey(0.2), .align = Align::Centre};
}

TextStyle chartTitleStyle() {
  return {.size = 13.0, .colour = grey(0.13), .bold = true};
}

void drawGrid(Drawing& drawing, const ChartGrid& grid, const ChartSize& size) {
  drawing.setTheme(grid.theme);
  drawing.fillBox({0, 0, size.width, size.height}, {1, 1, 1, 1});
  const PlacedGrid place = placed(drawing, grid, size);
  if (!grid.title.empty()) drawing.text(grid.title, {6.0, 20.0}, gridTitleStyle);
  if (!place.legend.empty()) drawLegend(drawing, place.legend, place.legendBox);
  for (size_t i = 0; i < place.cells.size(); ++i) {
    const PlacedCell& cell = place.cells[i];
    drawCell(drawing, grid.charts[i], cell.cell, cell.map, cell.look);
  }
}

}  // namespace marey::render

#include <algorithm>
#include <cmath>

#include "render/chart_private.h"

namespace marey::render {

namespace {
const TextStyle labelStyle{.size = 12.0, .colour = grey(0.2), .align = Align::Centre};
const TextStyle chartTitleStyle{.size = 13.0, .colour = grey(0.13), .bold = true};
const TextStyle gridTitleStyle{.size = 15.0, .colour = grey(0.1), .bold = true};

std::string axisTitle(const Axis& axis) {
  if (axis.unit.empty()) return axis.label;
  return axis.label + " [" + axis.unit + "]";
}

void drawAxes(Drawing& drawing, const Chart& chart, const Mapping& map, const CellLook& look) {
  const Box& plot = map.plot;
  const Colour gridColour = grey(0.91);
  if (chart.y.showTicks) {
    const Ticks ticks = ticksOf(chart.y, map.y, plot.height(), 36.0);
    for (size_t i = 0; i < ticks.values.size(); ++i) {
      const double y = map(map.x.low, ticks.values[i]).y;
      drawing.line({plot.left, y}, {plot.right, y}, gridColour, 1.0);
      TextStyle style = tickStyle();
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
      TextStyle style = tickStyle();
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

}  // namespace

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

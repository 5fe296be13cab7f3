// Private to the folder: the steps of drawing a chart.
#pragma once

#include <vector>

#include "render/base/drawing.h"
#include "render/chart/chart.h"
#include "render/chart/ticks.h"

namespace marey::render {

struct Range {
  double low = 0.0, high = 1.0;
};

/// Throws InputError when x, y, low and high of a series do not belong together.
void checkChart(const Chart& chart);
/// What an axis spans: its own range, its categories, or the data with a margin.
Range rangeOf(const Chart& chart, char axis);
/// One range for several charts.
Range joinedRange(const std::vector<Chart>& charts, char axis);

/// Where data lie on the page.
struct Mapping {
  Box plot;
  Range x, y;
  bool rowsFromTop = false;  ///< category rows count downwards
  Point operator()(double dataX, double dataY) const;
};

struct LegendItem {
  std::string name;
  Series look;
};
/// Every named series once, by name, over all charts.
std::vector<LegendItem> legendItems(const std::vector<Chart>& charts);
/// Draws items in lines from the top left of `box`; returns the height used.
double drawLegend(Drawing& drawing, const std::vector<LegendItem>& items, const Box& box);
/// The height that drawLegend would use.
double legendHeight(Drawing& drawing, const std::vector<LegendItem>& items, double width);
/// Names at the right ends of the lines, pushed apart where they would overlap.
void drawDirectLabels(Drawing& drawing, const Chart& chart, const Mapping& map);
double directLabelWidth(Drawing& drawing, const Chart& chart);

TextStyle tickStyle();
Ticks ticksOf(const Axis& axis, const Range& range, double pixels, double pixelsPerTick);

/// The text, cut with a dot-dot-dot where it is wider.
std::string elided(Drawing& drawing, const std::string& text, const TextStyle& style, double width);

/// "speed [cm/s]"
std::string axisTitle(const Axis& axis);
TextStyle axisTitleStyle();
TextStyle chartTitleStyle();

/// Names of rules inside the plot: not over each other as far as there is room.
struct PlacedText {
  std::string text;
  Point at;
  TextStyle style;
};
std::vector<PlacedText> ruleLabels(Drawing& drawing, const Chart& chart, const Mapping& map);
/// The rectangle of a text on the page; of turned ones only those that run upwards.
Box boxOf(Drawing& drawing, const std::string& text, Point at, const TextStyle& style);
bool overlap(const Box& a, const Box& b);

/// What a cell shows besides its plot.
struct CellLook {
  bool xLabels = true, yLabels = true, axisTitles = true;
};

struct PlacedCell {
  Box cell;
  Mapping map;
  CellLook look;
};

/// Where everything of a grid goes.
struct PlacedGrid {
  std::vector<LegendItem> legend;  ///< empty: none is drawn
  Box legendBox;
  std::vector<PlacedCell> cells;  ///< one per chart
};
PlacedGrid placed(Drawing& drawing, const ChartGrid& grid, const ChartSize& size);

/// Many lines as one picture (chart_cloud.cpp).
void drawCloud(Drawing& drawing, const Series& series, const Mapping& map);
/// One series inside the plot.
void drawSeries(Drawing& drawing, const Series& series, const Mapping& map);
/// The whole grid on a page of this size.
void drawGrid(Drawing& drawing, const ChartGrid& grid, const ChartSize& size);

}  // namespace marey::render

// Charts as plain data, drawn by one routine to SVG, PDF and pixels.
//
// A chart knows nothing of files or windows; the same data can be drawn by a report and by a
// window. Output is deterministic: equal charts give equal bytes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/base/chart_theme.h"
#include "render/base/colours.h"
#include "render/base/image.h"
#include "render/base/recipe.h"

namespace marey::render {

struct Axis {
  std::string label = {};
  std::string unit = {};                                ///< "cm/s"; shown in brackets, "" for none
  std::optional<std::pair<double, double>> range = {};  ///< default: fits the data, nice ends
  std::vector<std::string> categories = {};  ///< named rows (y, from the top) or columns (x): item
                                             ///< i covers [i, i+1], values lie at i + 0.5
  bool showTicks = true;                     ///< off where the scale means nothing (density height)
};

enum class SeriesKind {
  Line,            ///< y over x; NaN breaks the line
  Band,            ///< the area between low and high over x
  Density,         ///< y over x as an outlined area down to zero
  Bars,            ///< y over x from zero; `width` is in x units
  Intervals,       ///< bars from low to high along x in row y (gait diagrams)
  Dots,            ///< y over x; low..high, where given, is an error bar along `errorAxis`
  HorizontalRule,  ///< a line across the chart at y[0], labelled with its name
  VerticalRule,    ///< the same at x[0]
  Cloud,           ///< the lines of `cloud` over x, laid over each other as one picture
};

/// Many lines over common places: rows x (places of x), row by row; NaN breaks a line.
struct CloudLines {
  std::vector<float> y;
  double low = 0.0, high = 1.0;  ///< of the finite values

  explicit CloudLines(std::vector<float> rows);
};

struct Series {
  SeriesKind kind = SeriesKind::Line;
  std::string name = {};
  Colour colour = naturalColour();
  std::vector<double> x = {}, y = {};
  std::vector<double> low = {}, high = {};
  double width = 1.8;    ///< pixels; bars: x units; intervals: share of the row
  double opacity = 1.0;  ///< of the fill (bands, densities, bars)
  bool dashed = false;
  bool inLegend = true;
  char errorAxis = 'y';
  std::shared_ptr<const CloudLines> cloud = nullptr;  ///< of kind Cloud, whose `opacity` is that of
                                                      ///< one line and whose x rises
};

enum class LegendPlace {
  None,
  Top,     ///< one line of swatches under the title
  Direct,  ///< each line's name at its right end, in its colour
};

struct Chart {
  std::string title = {};
  Axis x = {}, y = {};
  std::vector<Series> series = {};
  LegendPlace legend = LegendPlace::Top;
};

/// Small multiples in reading order. Shared axes have one range and are labelled once.
struct ChartGrid {
  std::string title = {};
  std::vector<Chart> charts = {};
  int columns = 1;  ///< fewer or more where plots would be too small to read
  /// What the rows' plots have of the height, such as {1, 0.4}; empty: the same.
  std::vector<double> rowShares = {};
  bool shareX = false, shareY = false;
  ChartTheme theme = {};
};

/// CSS pixels (1/96 inch); text is 12 px = 9 pt or larger.
struct ChartSize {
  double width = 720.0, height = 320.0;
};

/// A grid of one.
ChartGrid single(Chart chart);

/// A whole SVG file; the recipe is in its <metadata>. Ids start with `idPrefix`, so that several
/// figures can stand in one HTML page. Throws InputError for series whose lengths disagree.
std::string drawSvg(const ChartGrid& grid, const ChartSize& size, const Recipe& recipe = {},
                    const std::string& idPrefix = "fig");
/// A one-page PDF; the recipe is its Subject. Throws InputError as drawSvg.
std::string drawPdf(const ChartGrid& grid, const ChartSize& size, const Recipe& recipe = {});
/// Pixels at `scale` times the size. Throws InputError as drawSvg.
Image drawImage(const ChartGrid& grid, const ChartSize& size, double scale = 1.0);

}  // namespace marey::render

// Where the data of a drawn chart lie on the page: what a window needs to put a cursor, a brush or
// a tooltip over a picture of a chart.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/chart/chart.h"

namespace marey::render {

/// The plot of one chart in the pixels of ChartSize (from the top left), and what its axes span.
struct ChartFrame {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  double xLow = 0.0, xHigh = 1.0, yLow = 0.0, yHigh = 1.0;
  bool rowsFromTop = false;  ///< category rows count downwards

  double pixelX(double dataX) const;
  double pixelY(double dataY) const;
  double dataX(double pixelX) const;
  double dataY(double pixelY) const;
  bool contains(double pixelX, double pixelY) const {
    return pixelX >= left && pixelX <= right && pixelY >= top && pixelY <= bottom;
  }
};

/// Frames of every chart of the grid in its order, as drawSvg, drawPdf and drawImage place them.
/// Throws InputError as those.
std::vector<ChartFrame> framesOf(const ChartGrid& grid, const ChartSize& size);

/// A text of a drawn chart and the rectangle that it fills, in the pixels of ChartSize.
struct ChartText {
  std::string text;
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
};
/// Every text, as drawSvg, drawPdf and drawImage place it. Throws InputError as those.
std::vector<ChartText> textsOf(const ChartGrid& grid, const ChartSize& size);

/// The height that a page of this width needs for every plot to be readable.
double leastHeight(const ChartGrid& grid, double width);

}  // namespace marey::render

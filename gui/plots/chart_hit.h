// What lies under the mouse in a chart.
#pragma once

#include <compare>
#include <optional>
#include <vector>

#include "render/chart/chart_frame.h"

namespace marey::gui {

/// A curve of a grid; `row` counts the lines of a cloud, -1 for other kinds.
struct CurveRef {
  int chart = -1, series = -1, row = -1;
  auto operator<=>(const CurveRef&) const = default;
};

struct ChartHit {
  int chart = -1;
  double x = 0.0, y = 0.0;        ///< the place in data
  std::optional<CurveRef> curve;  ///< the nearest one within reach
  double curveY = 0.0;            ///< its value at x; of a point: its y
};

/// The chart whose plot holds the pixel, and the nearest curve within `reach` pixels: lines come
/// before upright rules and these before bands. None outside every plot.
std::optional<ChartHit> hitAt(const render::ChartGrid& grid,
                              const std::vector<render::ChartFrame>& frames, double pixelX,
                              double pixelY, double reach = 10.0);

/// A curve drawn over the picture, without drawing that anew.
struct ChartHighlight {
  int chart = 0;
  std::vector<double> x, y;
  render::Colour colour;
};

/// Points of a line or of one row of a cloud. Throws std::out_of_range for a curve that is not
/// there.
struct CurvePoints {
  std::vector<double> x, y;
};
CurvePoints pointsOf(const render::ChartGrid& grid, const CurveRef& curve);

}  // namespace marey::gui

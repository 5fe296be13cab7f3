// How many motions a curve over time rests on: beyond the shorter ones it is a handful.
#pragma once

#include <vector>

#include "gui/plots/linked_grid.h"

namespace marey::gui {

struct MotionCount {
  SetLook look;
  double fps = 20.0;
  std::vector<int> goingOn;  ///< motions that have a value, per frame from the start
};

/// Adds a low chart "motions" below the charts of the grid, over the same time. Nothing where every
/// set keeps all of its motions to the end: then the number beside its name says it.
void addCountStrip(LinkedGrid& grid, const std::vector<MotionCount>& counts);

}  // namespace marey::gui

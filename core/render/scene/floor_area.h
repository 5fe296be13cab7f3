// Private to the folder: a part of the ground.
#pragma once

#include <algorithm>

namespace marey::render {

/// A rectangle of the floor, metres.
struct FloorArea {
  double x0 = 0, z0 = 0, x1 = 1, z1 = 1;
  double width() const { return x1 - x0; }
  double depth() const { return z1 - z0; }
  void include(double x, double z) {
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    z0 = std::min(z0, z);
    z1 = std::max(z1, z);
  }
  FloorArea grown(double margin) const {
    return {x0 - margin, z0 - margin, x1 + margin, z1 + margin};
  }
};

}  // namespace marey::render

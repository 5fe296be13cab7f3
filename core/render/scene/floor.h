// Private to the folder: the floor as pictures laid on the ground.
#pragma once

#include <vector>

#include "render/base/image.h"
#include "render/scene/bodies.h"

namespace marey::render {

/// A rectangle of the floor, metres.
struct FloorArea {
  double x0 = 0, z0 = 0, x1 = 1, z1 = 1;
  double width() const { return x1 - x0; }
  double depth() const { return z1 - z0; }
  void include(double x, double z);
  FloorArea grown(double margin) const {
    return {x0 - margin, z0 - margin, x1 + margin, z1 + margin};
  }
};

/// A picture of an area; row 0 is the edge z0, column 0 the edge x0.
struct FloorImage {
  FloorArea area;
  Image image;
};

struct FloorMark {
  double x = 0, z = 0;
  double radiusM = 0.05;
  Colour colour;
};

struct FloorSpec {
  FloorArea area;      ///< what the motion covers; the floor goes on and fades beyond it
  double gridM = 0.5;  ///< cell size; every metre is drawn stronger
  Colour background = {1, 1, 1, 1};
  std::vector<std::pair<double, double>> path;  ///< x, z
  std::vector<FloorMark> marks;
};

/// Floor, grid, path line with arrows, contact marks; fades to the background at its edges.
FloorImage paintFloor(const FloorSpec& spec);

/// A figure that casts a shadow.
struct Caster {
  const BodyShape* shape = nullptr;
  std::vector<Vec3> pose;
  double opacity = 1.0;
};
/// Shadows of all casters under a distant light: a point at height h shades the floor at
/// (x, z) + h * slant. Sharp near the feet, softer from higher up. Black with alpha.
FloorImage paintShadows(const std::vector<Caster>& casters, const Eigen::Vector2f& slant);

}  // namespace marey::render

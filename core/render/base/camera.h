// Cameras that see the whole motion.
#pragma once

#include <span>

#include "motion/clip.h"

namespace marey::render {

/// World metres; the picture's centre is at `target`.
struct Camera {
  Vec3 eye = {0, 1, 5}, target = {0, 1, 0}, up = {0, 1, 0};
  bool orthographic = false;
  double fovY = 0.5;     ///< radians, whole vertical angle (perspective)
  double heightM = 2.0;  ///< metres from the lower to the upper edge (orthographic)
  double nearM = 0.1, farM = 100.0;

  Vec3 forward() const { return (target - eye).normalized(); }
  Vec3 right() const { return forward().cross(up).normalized(); }
  Vec3 trueUp() const { return right().cross(forward()); }
};

/// Pixels from the picture's top left.
struct ScreenPoint {
  double x = 0.0, y = 0.0;
};
ScreenPoint project(const Camera& camera, const Vec3& world, int width, int height);

/// Edges of a picture to keep free, pixels.
struct Frame {
  int width = 800, height = 600;
  double left = 30, right = 30, top = 30, bottom = 30;
};

/// The main direction of travel of floor positions: from the first to the last where they are well
/// apart, else the long axis of their spread; unit length, y = 0. `fallback` where they stand
/// still.
Vec3 travelDirection(std::span<const Vec3> positions, const Vec3& fallback);

/// Unit directions of the picture in the world.
struct ViewAxes {
  Vec3 right, up, forward;
};
/// The nearest camera along `axes` that sees all points inside the frame.
/// Throws NumericError when there is no point.
Camera fitCamera(std::span<const Vec3> points, const ViewAxes& axes, bool orthographic,
                 const Frame& frame);

}  // namespace marey::render

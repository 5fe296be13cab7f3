// Private to the folder: cameras of a 3D view, and how a mouse moves them. Pure functions.
#pragma once

#include "render/base/camera.h"
#include "render/scene/scene.h"

namespace marey::render {

/// Vertical angle of every fitted camera, radians.
inline constexpr double viewFovY = 0.42;

/// The picture's directions for a preset, of motions that go along `travel` (level, of length 1)
/// and spread over the floor by `spreadM` across.
ViewAxes axesFor(View view, const Vec3& travel, double spreadM);
/// The light comes from the upper left of the viewer: x, z by which a metre of height shifts its
/// shadow.
Eigen::Vector2f lightFor(const ViewAxes& axes);

/// Sees all points inside the frame, along `axes`; turns about their middle.
Camera fittedCamera(std::span<const Vec3> points, const ViewAxes& axes, bool orthographic,
                    const Frame& frame);
/// Keeps what is in the middle at its size.
Camera withProjection(Camera camera, bool orthographic);
/// About the point looked at, radians; never below the floor.
Camera orbited(Camera camera, double aroundRad, double upRad);
/// By pixels of a picture `height` high.
Camera panned(Camera camera, double x, double y, int height);
/// Above 1 comes nearer.
Camera zoomed(Camera camera, double factor);

/// The line of sight through a pixel.
struct Sight {
  Vec3 origin, direction;
};
Sight sightOf(const Camera& camera, double x, double y, int width, int height);

}  // namespace marey::render

#include "render/scene/views.h"

#include <algorithm>
#include <cmath>

namespace marey::render {

namespace {
constexpr float lowestEyeM = 0.06F;  ///< above the floor

Vec3 level(const Vec3& v) {
  return {v.x(), 0.0F, v.z()};
}

/// The picture's directions, looking along `heading` (level) and down by `elevation`.
ViewAxes lookingDown(const Vec3& heading, float elevation) {
  const Vec3 forward = std::cos(elevation) * heading - std::sin(elevation) * Vec3::UnitY();
  const Vec3 right = heading.cross(Vec3::UnitY());
  return {right, right.cross(forward), forward};
}

double halfHeightAt(const Camera& camera, double depth) {
  return camera.orthographic ? 0.5 * camera.heightM : depth * std::tan(0.5 * camera.fovY);
}

/// The point looked at in the middle of what is seen, so that turning goes about it.
void aimAt(Camera& camera, const Vec3& centre) {
  const float depth = camera.forward().dot(centre - camera.eye);
  camera.target = camera.eye + std::max(0.3F, depth) * camera.forward();
}
}  // namespace

ViewAxes axesFor(View view, const Vec3& travel, double spreadM) {
  const auto turned = [&](float angle) {
    return Vec3(Eigen::AngleAxisf(angle, Vec3::UnitY()) * travel);
  };
  const auto quarter = static_cast<float>(0.5 * M_PI);
  switch (view) {
    // To the right and nearer: the viewer looks across the walk and somewhat against it.
    case View::ThreeQuarter:
      return lookingDown(turned(quarter + 0.5F),
                         static_cast<float>(0.32 + 0.23 * std::clamp(spreadM / 4.0, 0.0, 1.0)));
    case View::Side:
      return lookingDown(turned(quarter), 0.05F);
    case View::Front:
      return lookingDown(-travel, 0.10F);
    case View::Back:
      return lookingDown(travel, 0.10F);
    case View::Top:
      break;
  }
  return lookingDown(turned(quarter), quarter);
}

Eigen::Vector2f lightFor(const ViewAxes& axes) {
  // From above, long shadows would be taken for figures.
  if (axes.forward.y() < -0.99F) {
    const Vec3 shade = 0.12F * axes.right - 0.12F * axes.up;
    return {shade.x(), shade.z()};
  }
  const Vec3 shade = 0.34F * axes.right + 0.20F * Vec3::UnitY().cross(axes.right);
  return {shade.x(), shade.z()};
}

Camera fittedCamera(std::span<const Vec3> points, const ViewAxes& axes, bool orthographic,
                    const Frame& frame) {
  Camera camera = fitCamera(points, axes, orthographic, frame);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<float>(points.size());
  aimAt(camera, middle);
  camera.fovY = viewFovY;
  if (!camera.orthographic) {
    camera.heightM = 2.0 * halfHeightAt(camera, (camera.target - camera.eye).norm());
  } else {
    // Far enough away that a change to perspective keeps the size.
    const auto away = static_cast<float>(0.5 * camera.heightM / std::tan(0.5 * viewFovY));
    camera.eye = camera.target - away * camera.forward();
  }
  return camera;
}

Camera withProjection(Camera camera, bool orthographic) {
  if (camera.orthographic == orthographic) return camera;
  const double tangent = std::tan(0.5 * camera.fovY);
  if (orthographic) {
    camera.heightM = 2.0 * tangent * (camera.target - camera.eye).norm();
  } else {
    const auto away = static_cast<float>(0.5 * camera.heightM / tangent);
    camera.eye = camera.target - away * camera.forward();
  }
  camera.orthographic = orthographic;
  return camera;
}

Camera orbited(Camera camera, double aroundRad, double upRad) {
  const Vec3 forward = camera.forward();
  const float away = (camera.target - camera.eye).norm();
  // Looking straight down, the picture's upper edge tells the heading.
  const bool down = level(forward).norm() < 0.02F;
  const Vec3 heading = level(down ? camera.trueUp() : forward).normalized();
  const float lowest = std::asin(std::clamp((lowestEyeM - camera.target.y()) / away, -1.0F, 1.0F));
  const float elevation =
      std::clamp(std::asin(std::clamp(-forward.y(), -1.0F, 1.0F)) + static_cast<float>(upRad),
                 lowest, static_cast<float>(0.5 * M_PI));
  const Vec3 turned = Eigen::AngleAxisf(static_cast<float>(aroundRad), Vec3::UnitY()) * heading;
  const ViewAxes axes = lookingDown(turned, elevation);
  camera.eye = camera.target - away * axes.forward;
  camera.up = axes.up;
  return camera;
}

Camera panned(Camera camera, double x, double y, int height) {
  const double perPixel =
      halfHeightAt(camera, (camera.target - camera.eye).norm()) / (0.5 * std::max(1, height));
  Vec3 step = static_cast<float>(-x * perPixel) * camera.right() +
              static_cast<float>(y * perPixel) * camera.trueUp();
  step.y() = std::max(step.y(), std::min(0.0F, lowestEyeM - camera.eye.y()));
  camera.eye += step;
  camera.target += step;
  return camera;
}

Camera zoomed(Camera camera, double factor) {
  if (!(factor > 0.0)) return camera;
  camera.heightM = std::clamp(camera.heightM / factor, 0.02, 2000.0);
  const float away = (camera.target - camera.eye).norm();
  const float next = std::clamp(away / static_cast<float>(factor), 0.15F, 2000.0F);
  camera.eye = camera.target - next * camera.forward();
  camera.eye.y() = std::max(camera.eye.y(), std::min(lowestEyeM, camera.target.y()));
  return camera;
}

Sight sightOf(const Camera& camera, double x, double y, int width, int height) {
  const double scale = halfHeightAt(camera, 1.0) / (0.5 * height);
  const Vec3 across = static_cast<float>((x - 0.5 * width) * scale) * camera.right() +
                      static_cast<float>((0.5 * height - y) * scale) * camera.trueUp();
  if (camera.orthographic) return {camera.eye + across, camera.forward()};
  return {camera.eye, (camera.forward() + across).normalized()};
}

}  // namespace marey::render

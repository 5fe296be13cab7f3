#include "render/base/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "base/error.h"

namespace marey::render {

namespace {
struct Bounds {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  void include(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

/// For one screen direction: how near the eye may come along the view, and where across.
/// `minus` and `plus` are the tangents from the centre to the free edges on the two sides.
struct Slab {
  Bounds below, above;  ///< of across + minus * depth and across - plus * depth
  double minus, plus;
  void include(double across, double depth) {
    below.include(across + minus * depth);
    above.include(across - plus * depth);
  }
  double nearestDepth() const { return (below.low - above.high) / (minus + plus); }
  double across(double depth) const {
    return 0.5 * ((above.high + plus * depth) + (below.low - minus * depth));
  }
};

void setClipping(Camera& camera, std::span<const Vec3> points) {
  Bounds depth;
  for (const Vec3& p : points) depth.include((p - camera.eye).dot(camera.forward()));
  const double span = std::max(1.0, depth.high - depth.low);
  camera.nearM = std::max(0.02, depth.low - 0.6 * span);
  // The floor goes on behind the bodies.
  camera.farM = depth.high + 3.0 * span + 20.0;
}

Camera fitPerspective(std::span<const Vec3> points, const ViewAxes& axes, const Frame& frame) {
  Camera camera;
  camera.fovY = 0.42;
  const double scale = std::tan(camera.fovY / 2) / (0.5 * frame.height);
  Slab h{
      {}, {}, (0.5 * frame.width - frame.left) * scale, (0.5 * frame.width - frame.right) * scale};
  Slab v{{},
         {},
         (0.5 * frame.height - frame.bottom) * scale,
         (0.5 * frame.height - frame.top) * scale};
  for (const Vec3& p : points) {
    h.include(p.dot(axes.right), p.dot(axes.forward));
    v.include(p.dot(axes.up), p.dot(axes.forward));
  }
  const double depth = std::min(h.nearestDepth(), v.nearestDepth());
  camera.eye = axes.right * static_cast<float>(h.across(depth)) +
               axes.up * static_cast<float>(v.across(depth)) +
               axes.forward * static_cast<float>(depth);
  camera.target = camera.eye + axes.forward;
  camera.up = axes.up;
  return camera;
}

Camera fitOrthographic(std::span<const Vec3> points, const ViewAxes& axes, const Frame& frame) {
  Bounds h, v, depth;
  for (const Vec3& p : points) {
    h.include(p.dot(axes.right));
    v.include(p.dot(axes.up));
    depth.include(p.dot(axes.forward));
  }
  const double metresPerPixel =
      std::max((h.high - h.low) / std::max(1.0, frame.width - frame.left - frame.right),
               (v.high - v.low) / std::max(1.0, frame.height - frame.top - frame.bottom));
  Camera camera;
  camera.orthographic = true;
  camera.heightM = metresPerPixel * frame.height;
  const double x = 0.5 * (h.low + h.high) + 0.5 * (frame.right - frame.left) * metresPerPixel;
  const double y = 0.5 * (v.low + v.high) + 0.5 * (frame.top - frame.bottom) * metresPerPixel;
  camera.eye = axes.right * static_cast<float>(x) + axes.up * static_cast<float>(y) +
               axes.forward * static_cast<float>(depth.low - 5.0);
  camera.target = camera.eye + axes.forward;
  camera.up = axes.up;
  return camera;
}
}  // namespace

ScreenPoint project(const Camera& camera, const Vec3& world, int width, int height) {
  const Vec3 offset = world - camera.eye;
  const double depth = offset.dot(camera.forward());
  const double halfHeight =
      camera.orthographic ? 0.5 * camera.heightM : depth * std::tan(0.5 * camera.fovY);
  const double pixels = 0.5 * height / halfHeight;
  return {0.5 * width + pixels * offset.dot(camera.right()),
          0.5 * height - pixels * offset.dot(camera.trueUp())};
}

Vec3 travelDirection(std::span<const Vec3> positions, const Vec3& fallback) {
  if (positions.empty()) return fallback;
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (const Vec3& p : positions) mean += Eigen::Vector2f(p.x(), p.z());
  mean /= static_cast<float>(positions.size());
  Eigen::Matrix2f spread = Eigen::Matrix2f::Zero();
  for (const Vec3& p : positions) {
    const Eigen::Vector2f d = Eigen::Vector2f(p.x(), p.z()) - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> solver(spread /
                                                              static_cast<float>(positions.size()));
  const float extent = std::sqrt(std::max(0.0F, solver.eigenvalues()(1)));
  if (extent < 0.15F) return fallback;
  Vec3 net = positions.back() - positions.front();
  net.y() = 0.0F;
  if (net.norm() > 2.0F * extent) return net.normalized();
  const Eigen::Vector2f axis = solver.eigenvectors().col(1);
  const Vec3 along = Vec3(axis.x(), 0.0F, axis.y()).normalized();
  return along.dot(fallback) < 0.0F ? Vec3(-along) : along;
}

Camera fitCamera(std::span<const Vec3> points, const ViewAxes& axes, bool orthographic,
                 const Frame& frame) {
  if (points.empty()) throw NumericError("a camera needs at least one point to look at");
  Camera camera =
      orthographic ? fitOrthographic(points, axes, frame) : fitPerspective(points, axes, frame);
  setClipping(camera, points);
  return camera;
}

}  // namespace marey::render

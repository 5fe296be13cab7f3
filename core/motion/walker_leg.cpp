#include "motion/walker_leg.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace marey::walker {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d boneFrame(const Vector3d& hinge, const Vector3d& downwards) {
  Eigen::Matrix3d m;
  m.col(0) = hinge;
  m.col(1) = -downwards.normalized();
  m.col(2) = m.col(0).cross(m.col(1));
  return m;
}

}  // namespace

LegPose solveLeg(const Vector3d& hip, const Vector3d& ankle, const Vector3d& forward, double thighM,
                 double shankM) {
  const Vector3d line = ankle - hip;
  const double reach = line.norm();
  const Vector3d down = line / reach;
  const Vector3d bend = (forward - forward.dot(down) * down).normalized();
  // Law of cosines: foot of the knee's perpendicular on the line from hip to ankle.
  const double a = (thighM * thighM - shankM * shankM + reach * reach) / (2.0 * reach);
  const double b = std::sqrt(std::max(0.0, thighM * thighM - a * a));
  LegPose pose;
  pose.knee = hip + a * down + b * bend;
  const Vector3d hinge = (-down).cross(bend);
  pose.thigh = boneFrame(hinge, pose.knee - hip);
  pose.shank = boneFrame(hinge, ankle - pose.knee);
  return pose;
}

}  // namespace marey::walker

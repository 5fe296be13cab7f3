// Analytic inverse kinematics of a two-bone limb.
#pragma once

#include <Eigen/Core>

namespace marey::walker {

struct LegPose {
  Eigen::Vector3d knee;
  Eigen::Matrix3d thigh, shank;  ///< world; columns: hinge axis (left), bone upwards, forward
};

/// Knee of a leg from `hip` to `ankle` with the given bone lengths; it bends towards `forward`.
/// The distance is taken to be at most the sum of the lengths (the caller sees to it).
LegPose solveLeg(const Eigen::Vector3d& hip, const Eigen::Vector3d& ankle,
                 const Eigen::Vector3d& forward, double thighM, double shankM);

}  // namespace marey::walker

// Representations of a rotation and the ways between them. Radians; quaternions of unit length;
// double precision, because Euler angles lose digits near their singularity.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace marey {

using Quatd = Eigen::Quaterniond;
using Vec3d = Eigen::Vector3d;

/// Three axes (0 = x, 1 = y, 2 = z) of intrinsic turns, as the channels of a BVH file list them:
/// "ZXY" means R = Rz(angles[0]) Rx(angles[1]) Ry(angles[2]).
struct EulerOrder {
  std::array<int, 3> axes = {2, 0, 1};

  std::string text() const;
  /// Three different axes (Tait-Bryan); else first and last are the same (proper Euler).
  bool allDifferent() const { return axes[0] != axes[2]; }
  bool operator==(const EulerOrder&) const = default;
};

/// "ZXY", "xyz", "ZXZ", ... Throws InputError unless there are three axes of which no two
/// neighbours are the same.
EulerOrder parseEulerOrder(std::string_view text);

/// A turn about one coordinate axis.
Quatd axisRotation(int axis, double angle);

Quatd quatFromEuler(const Vec3d& angles, const EulerOrder& order);
/// Middle angle in [-pi/2, pi/2] (Tait-Bryan) or [0, pi] (proper Euler), the others in
/// (-pi, pi]. Where only a sum of first and last is determined, the last is 0.
/// Source: Bernardes & Viollet 2022, "Quaternion to Euler angles conversion: a direct, general
/// and computationally efficient method".
Vec3d eulerFromQuat(const Quatd& rotation, const EulerOrder& order);
/// The same rotation in the angles nearest to `previous` (whole turns, the second solution of the
/// middle angle, and the free split at the singularity are used), so that curves do not jump.
Vec3d eulerNear(const Quatd& rotation, const EulerOrder& order, const Vec3d& previous);
/// Axis times angle, angle in [0, pi]; a series replaces the quotient near the identity.
Vec3d logMap(const Quatd& rotation);
Quatd expMap(const Vec3d& axisAngle);
/// Of all vectors whose expMap is `rotation` (their angles differ by whole turns) the one nearest
/// to `before`, so that curves do not jump where an angle passes pi.
Vec3d logNear(const Quatd& rotation, const Vec3d& before);

/// Angle in [0, pi] between two rotations; exact for small ones too.
double angleBetween(const Quatd& a, const Quatd& b);
/// The shortest turn that takes direction `from` to direction `to` (any lengths but zero);
/// for opposite directions some half turn. Throws NumericError for a zero vector.
Quatd shortestArc(const Vec3d& from, const Vec3d& to);

}  // namespace marey

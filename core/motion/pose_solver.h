// One pose of a skeleton with constant bones that comes nearest to given joint positions.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "motion/clip.h"
#include "motion/rotation.h"

namespace marey {

/// World rotations of every joint and the place of the root.
struct WorldPose {
  Vec3d root = Vec3d::Zero();
  std::vector<Quatd> rotations;
};

/// What the positions of a joint's children say of its rotation.
enum class Observed {
  Nothing,    ///< no child away from the joint
  Direction,  ///< children on one line: where it points, not the twist about it
  Rotation    ///< children in two directions or more
};

/// Keeps rotations that positions show badly near those of the frame before: every joint with
/// Observed::Rotation, against its nearest ancestor of that kind (or the world), so that a body
/// that turns takes its parts along.
struct Hold {
  WorldPose before;
  double weight = 0.0;  ///< square metres per square radian
};

/// Levenberg-Marquardt on the sum over joints of squared distances, over world rotations and the
/// root's place. The unknowns are world rotations, so that each moves one bone's subtree without
/// turning it: along the tree the normal equations are sums over subtrees in closed form, which no
/// general solver knows of, and Eigen's Cholesky decomposition suffices. (A joint with one child
/// has no gradient in its twist; the damping keeps that where it was.)
class PoseSolver {
 public:
  /// Offsets are those of the skeleton; they should not all be zero.
  explicit PoseSolver(const Skeleton& skeleton);

  /// Starts from `pose` or from every bone aligned alone, whichever is nearer, and leaves the
  /// nearest pose there; returns the sum of squares, with that of the hold where there is one. An
  /// empty `pose` is no start. `target`: joints, metres.
  double solve(std::span<const Vec3> target, WorldPose& pose, const Hold* hold = nullptr) const;

  Observed observed(int joint) const { return m_observed[static_cast<size_t>(joint)]; }
  /// Of a joint of which a direction is observed: that direction at rest, unit length.
  const Vec3d& axis(int joint) const { return m_axes[static_cast<size_t>(joint)]; }
  std::vector<Vec3d> positions(const WorldPose& pose) const;

 private:
  struct System;
  WorldPose aligned(std::span<const Vec3> target) const;
  Quatd alignedJoint(int joint, const Quatd& parent, std::span<const Vec3> target) const;
  double cost(const WorldPose& pose, std::span<const Vec3> target, const Hold* hold) const;
  void build(const WorldPose& pose, std::span<const Vec3> target, System& system) const;
  /// Turn of a joint against where the hold wants it, world axes, radians.
  Vec3d strayed(const WorldPose& pose, const WorldPose& before, size_t joint) const;
  void addHold(const WorldPose& pose, const Hold& hold, System& system) const;
  WorldPose stepped(const WorldPose& pose, const Eigen::VectorXd& step) const;

  std::vector<int> m_parents;
  std::vector<std::vector<int>> m_children;
  std::vector<Vec3d> m_offsets;
  std::vector<int> m_below;  ///< joints of the subtree, itself among them
  std::vector<Observed> m_observed;
  std::vector<Vec3d> m_axes;
  std::vector<int> m_anchors;  ///< nearest ancestor with Observed::Rotation, -1 for none
  std::vector<int> m_unknown;  ///< first unknown of a joint's rotation, -1 where none is observed
  int m_unknowns = 3;          ///< the root's place comes first
};

}  // namespace marey

// The look of a skeleton: tapered capsules from joint to joint, and a head.
#pragma once

#include <span>
#include <vector>

#include "motion/clip.h"

namespace marey::render {

/// A round bone from one joint to another, or a ball where they are the same joint.
struct Capsule {
  int from = 0, to = 0;
  float radiusFrom = 0.03F, radiusTo = 0.03F;  ///< metres
  bool leftSide = false;  ///< drawn lighter, so that the legs can be told apart
};

/// The look of a skeleton, the same for every pose.
struct BodyShape {
  std::vector<Capsule> capsules;
  int head = -1;  ///< joint of the head ball, -1 for none
  int neck = -1;  ///< joint that the head ball points away from
  float headRadiusM = 0.0F;
};

/// Limbs taper towards hands and feet; sizes follow the longest bone of `pose` (joints, world
/// metres), so that people and dogs of any size look alike.
BodyShape bodyShape(const Skeleton& skeleton, std::span<const Vec3> pose);

/// World position of the head ball's centre; only where shape.head >= 0.
Vec3 headCentre(const BodyShape& shape, std::span<const Vec3> pose);

}  // namespace marey::render

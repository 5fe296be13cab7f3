// Forward kinematics: from local transforms along the tree to world positions and rotations.
#pragma once

#include <vector>

#include "motion/clip.h"

namespace marey {

/// World positions, frames x joints, metres: a joint sits where its parent's world transform
/// carries its translation. Throws InputError unless both parts of `local` have the same size, a
/// multiple of the joint count.
std::vector<Vec3> forwardKinematics(const Skeleton& skeleton, const JointTransforms& local);

/// World rotations, frames x joints, unit length. Throws InputError as above.
std::vector<Quat> globalRotations(const Skeleton& skeleton, const JointTransforms& local);

/// Joint positions of the rest pose: offsets summed from the root (which is at its own offset).
std::vector<Vec3> restPositions(const Skeleton& skeleton);

/// Rest lengths of Skeleton::bones(), metres.
std::vector<float> boneLengths(const Skeleton& skeleton);

}  // namespace marey

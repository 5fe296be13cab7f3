// From joint positions to joint rotations: the motion of a skeleton with constant bones that comes
// nearest to a clip of positions, as formats that store rotations need it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "motion/clip.h"

namespace marey {

/// How far a fitted motion stays from the positions it was fitted to.
struct FitResidual {
  std::vector<std::string> joints;
  std::vector<double> rmsM;  ///< per joint, over frames; metres
  std::vector<double> maxM;  ///< per joint, over frames; metres
  std::vector<int> frames;   ///< per joint, those that rmsM is over

  /// Over all joints; 0 where there are none.
  double largestM() const;
};

/// Of two clips together; joints are matched by name.
FitResidual pooled(const FitResidual& a, const FitResidual& b);

struct SkeletonFit {
  /// The clip's; with offsets from its positions (withOffsetsFrom) where all of them are zero.
  std::shared_ptr<const Skeleton> skeleton;
  JointTransforms transforms;  ///< translations are the offsets, except of the root
  FitResidual residual;
};

/// Per frame, the rotations and the root's place with the least sum of squared distances to the
/// positions (see PoseSolver). Where positions contradict the skeleton (samples whose shoulders
/// draw together), rotations that they show badly are held near those of the frame before, the
/// more the larger the contradiction (see Hold). Where positions leave a rotation open, it moves
/// least: a joint whose children lie on one line turns without twist against its parent from frame
/// to frame and drifts back to no twist against the rest pose within half a second; a joint without
/// children keeps its rest rotation. Deterministic. Throws InputError as validate(Clip) does.
SkeletonFit fitSkeleton(const Clip& clip);

/// The clip with the skeleton and rotations of its fit, positions where those put the joints.
Clip withFit(Clip clip, const SkeletonFit& fit);

/// The skeleton with offsets from a clip of positions: a bone has its mean length, in the
/// direction it has in the first frame; the root is at its first position.
std::shared_ptr<const Skeleton> withOffsetsFrom(const Clip& clip);

}  // namespace marey

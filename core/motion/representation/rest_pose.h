// The pose that rotations are relative to, and clips with rotations about a skeleton's joints.
#pragma once

#include <memory>
#include <vector>

#include "motion/representation/representation.h"
#include "motion/rotation.h"

namespace marey {

/// Local rotations of the skeleton's rest pose.
std::vector<Quatd> restRotations(const Skeleton& skeleton);

/// The first clip's skeleton, with bones from its positions where it has none, and with the clips'
/// mean pose as rest pose: of every joint the rotation whose mean squared chordal distance to its
/// local rotations is least, of the root those seen from the root frame (Markley et al. 2007,
/// "Averaging quaternions"). The identity pose of a file is not used: files put it anywhere (all
/// bones along one axis), which places legs at half a turn, where an exponential map is not unique.
std::shared_ptr<const Skeleton> withRestPose(const std::vector<Clip>& clips,
                                             const FeatureSpec& spec);

/// The clip with local rotations about the joints of `skeleton`, which has the same joints: its own
/// where they make its positions (within 1 mm) and its bones have the skeleton's directions (within
/// 0.01 rad; lengths may differ); else those of fitSkeleton, with bones of the skeleton's
/// directions and the clip's mean lengths. Positions stay as they are.
ReadyClip withRotations(Clip clip, const Skeleton& skeleton);

}  // namespace marey

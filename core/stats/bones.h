// Bone lengths: how far a motion is from a rigid skeleton.
#pragma once

#include <vector>

#include "motion/clip.h"

namespace marey::stats {

/// Rest lengths of Skeleton::bones(), metres; those of offset zero are zero.
std::vector<double> skeletonBoneLengths(const Skeleton& skeleton);
/// Of every bone the sum of its lengths over the frames of a clip, metres.
std::vector<double> boneLengthSums(const Clip& clip);
/// Mean length of every bone over all frames of all clips, metres.
/// Throws InputError on no clips or clips of different joints.
std::vector<double> meanBoneLengths(const std::vector<Clip>& clips);
/// Sum over frames and bones of the squared deviation from `reference`, square metres.
/// Throws InputError unless there is a reference for every bone.
double squaredBoneError(const Clip& clip, const std::vector<double>& reference);
/// Root mean square deviation over all bones and frames (Henter et al. 2020, Sec. 5.3), centimetres.
double boneLengthRmseCm(const std::vector<Clip>& clips, const std::vector<double>& reference);

/// Throws InputError unless every clip has the joints of the first one.
void requireSameJoints(const std::vector<Clip>& clips);

}  // namespace marey::stats

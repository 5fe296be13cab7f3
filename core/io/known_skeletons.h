// Skeletons of formats that store positions without naming joints.
#pragma once

#include <memory>

#include "motion/skeleton.h"

namespace marey::io {

/// The 21 joints of the field's locomotion NPZ files (Holden et al. 2017's choice out of CMU's
/// 31): hips, legs, spine, arms; left first. Offsets are zero.
Skeleton locomotionSkeleton();
/// The 27 joints of the dog of Zhang et al. 2018, end sites included. Offsets are zero.
Skeleton dogSkeleton();
/// The joints of SMPL (Loper et al. 2015; 24, or 22 without the hands), SMPL-H (52: 15 joints of
/// fingers a hand) or SMPL-X (55: jaw and eyes before those), in the order of their code; null for
/// another number. Offsets are zero.
std::shared_ptr<const Skeleton> smplSkeleton(int joints);

}  // namespace marey::io

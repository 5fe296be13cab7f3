// Skeletons of formats that store positions without naming joints.
#pragma once

#include "motion/skeleton.h"

namespace marey::io {

/// The 21 joints of the field's locomotion NPZ files (Holden et al. 2017's choice out of CMU's
/// 31): hips, legs, spine, arms; left first. Offsets are zero.
Skeleton moglowSkeleton();
/// The 27 joints of the dog of Zhang et al. 2018, end sites included. Offsets are zero.
Skeleton dogSkeleton();

}  // namespace marey::io

// Skeletons of formats that store positions without naming joints.
#pragma once

#include <memory>

#include "motion/clip.h"

namespace marey::io {

/// The 21 joints of the field's locomotion NPZ files (Holden et al. 2017's choice out of CMU's
/// 31): hips, legs, spine, arms; left first. Offsets are zero.
Skeleton moglowSkeleton();
/// The 27 joints of the dog of Zhang et al. 2018, end sites included. Offsets are zero.
Skeleton dogSkeleton();

/// The skeleton with offsets from a clip of positions: a bone has its mean length, in the
/// direction it has in the first frame; the root is at its first position.
std::shared_ptr<const Skeleton> withOffsetsFrom(const Clip& clip);

}  // namespace marey::io

// Change of frame rate: positions linear in time, rotations by slerp.
#pragma once

#include "motion/clip.h"

namespace marey {

/// Frame k of the result is at time k / fps of the clip; the last one is at or before its end.
/// The clip itself when the rate is the same. Throws InputError unless fps > 0.
Clip resampled(const Clip& clip, double fps);

}  // namespace marey

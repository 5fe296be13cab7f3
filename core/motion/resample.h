// Change of frame rate: turns by slerp and forward kinematics, so that bones keep their lengths.
#pragma once

#include "motion/clip.h"

namespace marey {

/// Frame k of the result is at time k / fps of the clip; the last one is at or before its end.
/// Where that is the time of a frame of the clip (always, where the rates are in a whole-number
/// ratio), that frame is taken over as it is. Between frames:
///   - of a clip with transforms, rotations by slerp, translations by Catmull-Rom, positions by
///     forward kinematics: a bone of constant length keeps it;
///   - of a clip without, and of one whose positions are not those of its transforms (a fit, by
///     more than 0.1 mm), positions by Catmull-Rom.
/// Catmull-Rom: the cubic with tangents (p[k+1] - p[k-1]) / 2, at the ends p[1] - p[0]; what does
/// not move stays exactly where it is. Source: Catmull and Rom 1974, "A class of local
/// interpolating splines"; Shoemake 1985, "Animating rotation with quaternion curves". The clip
/// itself when the rate is the same. Throws InputError unless fps > 0.
Clip resampled(const Clip& clip, double fps);

}  // namespace marey

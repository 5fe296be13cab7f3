// Where feet are put: displacements between rests, which jitter is not. What to count where a path
// stands still, instead of runs of slow frames.
#pragma once

#include "motion/clip.h"

namespace marey::stats {

/// A foot rests once it has kept within `restM` of its place for `restS`; it leaves its rest when
/// it is further than `leaveM` from it. The two radii are apart (hysteresis), so that shaking about
/// a place is neither.
struct DisplacementRule {
  double leaveM = 0.03;
  double restM = 0.01;
  double restS = 0.2;
};

/// How often a joint came to rest further than `leaveM` (over the floor) from where it rested
/// before. Positions over frames [first, last); the first rest counts nothing.
int displacements(const Clip& clip, int joint, int first, int last,
                  const DisplacementRule& rule = {});
/// Over the whole clip.
int displacements(const Clip& clip, int joint, const DisplacementRule& rule = {});

}  // namespace marey::stats

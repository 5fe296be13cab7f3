// Smoothness of joints and obedience of the root to a wanted path.
#pragma once

#include <vector>

#include "motion/clip.h"
#include "motion/features.h"

namespace marey::stats {

struct JerkTally {
  double sum = 0.0;    ///< of norms, m/s^3
  double count = 0.0;  ///< joints x (frames - 3)
};
/// Norm of the third difference of the world position times the rate cubed, m/s^3 (per second, not
/// per frame), over joints and frames; nothing for clips of fewer than four frames.
JerkTally jerk(const Clip& clip);

struct PathError {
  double meanM = 0.0, maximumM = 0.0, finalM = 0.0;
  double headingMeanRad = 0.0;
};
/// Floor distance of a root trajectory from the wanted one at equal times, over the frames that
/// both have. Throws InputError when either is empty.
PathError pathError(const std::vector<RootFrame>& walked, const std::vector<RootFrame>& wanted);

}  // namespace marey::stats

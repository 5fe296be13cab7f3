// Where a path stands still.
#pragma once

#include <vector>

#include "motion/features.h"

namespace marey {

/// A root stands where it is slower than this over the floor ...
inline constexpr double kStandingMS = 0.05;
/// ... and turns slower than this.
inline constexpr double kStandingRadS = 0.1;
/// Shorter stands are part of a walk: the change from one foot to the other.
inline constexpr double kShortestStandS = 1.0;

/// Frames [first, last) of a path in which it stands for at least kShortestStandS.
struct Stand {
  int first = 0, last = 0;
};
std::vector<Stand> standsOf(const std::vector<RootFrame>& path, double fps);
/// Time in which a path stands, seconds.
double standingSeconds(const std::vector<RootFrame>& path, double fps);

}  // namespace marey

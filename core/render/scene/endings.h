// Motions that have ended while longer ones go on.
#pragma once

#include <algorithm>

namespace marey::render {

/// What is left of a figure, and how long its fading takes, seconds.
inline constexpr double endedOpacity = 0.2, endingS = 0.5;

/// How much of a figure is there at a time: 1 up to its last frame, then less until it is the pale
/// trace of where the motion ended. The window, stills and films follow the same rule.
inline double presenceAt(double timeS, double lastFrameS) {
  const double past = timeS - lastFrameS;
  if (past < 1e-6) return 1.0;  // rounding of the end itself
  return std::max(endedOpacity, 1.0 - (1.0 - endedOpacity) * past / endingS);
}

}  // namespace marey::render

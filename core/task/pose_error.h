// How far motions are from what really came.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "motion/clip.h"

namespace marey {

/// Mean distance of joints from their reference (mean per joint position error of motion
/// prediction, after Ionescu et al. 2014: Human3.6M, Sec. 4), in the world, centimetres.
struct PoseError {
  double meanCm = 0.0;            ///< over motions, joints and frames
  double bestCm = 0.0;            ///< of the nearest motion, over joints and frames
  std::vector<double> byFrameCm;  ///< [frames], over motions and joints; the first is of frame 0
};

/// Over the frames that all have. Throws InputError without a motion or with other joints.
PoseError poseError(std::span<const Clip> motions, const Clip& reference);

/// Horizons at which prediction is usually judged, milliseconds.
inline constexpr int kHorizonsMs[] = {80, 160, 320, 400, 560, 1000};
/// (milliseconds, centimetres) of the horizons that the motions reach. Frame 0 of a motion is one
/// frame after the last that was given.
std::vector<std::pair<int, double>> errorsAtHorizons(const PoseError& error, double fps);

}  // namespace marey

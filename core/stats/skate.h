// Foot skate and contact by published rules: where a rule names a published code, it gives that
// code's number. They disagree with each other and are not zero for natural motion: give the
// natural value beside every one.
#pragma once

#include <vector>

#include "motion/clip.h"

namespace marey::stats {

/// Height of the floor below each foot joint, metres: the 5th percentile of the joint's height over
/// all frames (an ankle stands some centimetres above the floor that it touches by its sole).
std::vector<double> standingHeights(const std::vector<Clip>& clips, const std::vector<int>& feet);

/// Sums over the frames of one clip (frames t >= 1); a set's value is sum / frames.
struct SkateTally {
  double sum = 0.0;
  double frames = 0.0;
};

/// Mean skate s = v (2 - 2^(h/H)), 0 where h > H, with H = 2.5 cm and v horizontal speed in cm/s
/// (Zhang et al. 2018, MANN); ours: h is the height of the foot above standing, and the mean is
/// over feet and frames.
SkateTally heightWeightedSkate(const Clip& clip, const std::vector<int>& feet,
                               const std::vector<double>& standingHeights);
/// Share of frames in which some toe skates: lower than 5 cm (above the floor y = 0) in this frame
/// and the one before, and faster over the floor than 50 cm/s in this frame and in the mean of five
/// frames about it (zeros beyond the ends). The skating ratio of Guided Motion Diffusion
/// (Karunratanakul et al. 2023, calculate_skating_ratio at 2f6264a), which has it at 20 fps and for
/// joints 10 and 11 of HumanML3D, the toes.
SkateTally skatingShare(const Clip& clip, const std::vector<int>& toes);
/// Share of feet and frames in contact: squared displacement in a thirtieth of a second below
/// 0.02 cm^2, which is a speed below 4.24 cm/s. The test is that of LaFAN1's extract_feet_contacts
/// (Harvey et al. 2020, in centimetres at 30 fps); ours: other rates by speed, the mean over
/// feet and frames, and no repeat of the last frame.
SkateTally contactShare(const Clip& clip, const std::vector<int>& feet);

}  // namespace marey::stats

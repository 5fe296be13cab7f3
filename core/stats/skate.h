// Foot skate and contact by published rules. They disagree with each other and are not zero for
// natural motion: give the natural value beside every one.
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

/// Mean skate s = v (2 - 2^(h/H)), 0 where h > H, with H = 2.5 cm, v horizontal speed in cm/s and h
/// the height of the foot above standing; over feet and frames (Zhang et al. 2018, MANN).
SkateTally heightWeightedSkate(const Clip& clip, const std::vector<int>& feet,
                               const std::vector<double>& standingHeights);
/// Share of frames in which some foot is lower than 5 cm above standing now and in the frame before
/// and moves faster than 50 cm/s, which is 2.5 cm per frame at 20 fps (Karunratanakul et al. 2023,
/// Guided Motion Diffusion).
SkateTally skatingShare(const Clip& clip, const std::vector<int>& feet,
                        const std::vector<double>& standingHeights);
/// Share of feet and frames in contact: squared displacement in a thirtieth of a second below
/// 0.02 cm^2, which is a speed below 4.24 cm/s (LaFAN1: Harvey et al. 2020; the rule of Holden et
/// al. 2016 with its factor).
SkateTally contactShare(const Clip& clip, const std::vector<int>& feet);

}  // namespace marey::stats

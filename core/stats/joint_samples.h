// What is measured of a joint at every frame: the numbers behind per-joint distributions.
#pragma once

#include <string>
#include <vector>

#include "motion/clip.h"

namespace marey::stats {

/// Sideways and Forward are the joint's place in the root frame on the floor (features.h); Height
/// is its true height. Speed is that of the joint in the world, from the frame before. Angle is the
/// bend at the joint: between the bone that comes in and the first one that goes on (0: straight).
enum class Quantity { Speed, Height, Sideways, Forward, Angle };

struct QuantityText {
  std::string name;  ///< "speed"
  std::string unit;  ///< "cm/s"
};
const QuantityText& textOf(Quantity quantity);
const std::vector<Quantity>& allQuantities();

/// Whether the quantity exists for that joint (an angle needs a bone on both sides).
bool isDefined(const Skeleton& skeleton, Quantity quantity, int joint);

/// The quantity of every joint of a clip: samples[joint][frame], in the unit of textOf; empty
/// where it is not defined. Every `stride`-th frame, from frame `phase` of those
/// that have a value. Throws InputError where Sideways or Forward is
/// asked for of a skeleton without left and right hip.
std::vector<std::vector<double>> jointSamples(const Clip& clip, Quantity quantity, int stride = 1,
                                              int phase = 0);

/// The samples of one joint over many clips, for a plot. Throws InputError where it is not defined.
std::vector<double> pooledSamples(const std::vector<Clip>& clips, Quantity quantity, int joint);

}  // namespace marey::stats

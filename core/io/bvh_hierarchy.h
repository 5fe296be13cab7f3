// The first part of a BVH file: trees of joints and what each number of a frame means.
#pragma once

#include <string>
#include <vector>

#include "io/text.h"
#include "motion/skeleton.h"

namespace marey::io {

/// Of one joint: three positions and up to six turns; no writer has more.
constexpr size_t kMostBvhChannels = 9;

struct BvhChannel {
  int axis = 0;
  bool rotation = false;
};

/// One ROOT and what hangs on it; lengths in file units.
struct BvhTree {
  Skeleton skeleton;
  std::vector<std::vector<BvhChannel>> channels;  ///< per joint, in the order of the numbers
  int64_t line = 0;                               ///< of its ROOT

  size_t channelCount() const;
};

struct BvhHierarchy {
  std::vector<BvhTree> trees;  ///< numbers of a frame come tree by tree
  std::vector<std::string> notes;

  size_t channelCount() const;
  size_t jointCount() const;
};

/// Reads up to and including the word MOTION; nothing is tied to lines. Names of one tree differ:
/// repeated ones are numbered and noted. Throws InputError with the line.
BvhHierarchy readBvhHierarchy(WordReader& words);

}  // namespace marey::io

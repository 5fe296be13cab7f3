// The second part of a BVH file: how many frames, how long each, and their numbers.
#pragma once

#include "io/bvh.h"
#include "io/bvh_hierarchy.h"

namespace marey::io {

struct BvhMotion {
  std::vector<JointTransforms> trees;  ///< of every tree of the hierarchy
  std::string frameTime;               ///< as written; empty where the file states none
  std::vector<std::string> notes;
  std::string_view rest;   ///< what follows the last row
  int64_t restBefore = 0;  ///< lines before it
};

/// Reads from after the word MOTION. `turns`: per joint of all trees, see turnsInOrder.
///
/// A row may be broken over lines, or several stand on one, as long as one reading fits: rows that
/// begin where lines begin may be one more or less than the header says (the last may be cut: it is
/// left out), rows that do not must be exactly as many. `wholeRows` takes any number of rows.
/// Throws InputError with line, frame and both counts.
BvhMotion readBvhMotion(WordReader& words, const BvhHierarchy& hierarchy,
                        const std::vector<std::vector<size_t>>& turns, bool wholeRows);

}  // namespace marey::io

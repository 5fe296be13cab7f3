// What is looked at together: natural clips and sample sets, as plain values.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiment/sample_set.h"

namespace marey {

struct Motion {
  ClipPtr clip;
  std::optional<ClipScore>
      score;                ///< of a sample under its own model; natural clips: see Workspace
  bool visible = true;      ///< drawn; changes nothing but pictures
  bool used = true;         ///< counted by plots and statistics
  std::string source = {};  ///< of natural motion: the document's name for where it comes from
  /// The control that it follows, where its group has no single path.
  std::shared_ptr<const std::vector<RootFrame>> wanted = {};
  int follows = -1;  ///< the natural motion whose control that is, by its index in its group
};

/// The natural clips, or the motions of one sample set.
struct MotionGroup {
  int id = 0;  ///< never used again
  std::string name;
  std::string system;    ///< of the document; empty for natural motion
  int colourIndex = -1;  ///< of render::colourOf; -1: natural motion
  bool pinned = false;   ///< never replaced by sampling again
  bool complete = true;  ///< false while motions are being added
  std::optional<SampleRecipe> recipe;
  std::string modelHash;
  std::vector<RootFrame> wanted;  ///< the path that was asked for
  std::vector<Motion> motions;
  std::string modelStamp = {};  ///< of the model's file when they were drawn (ModelCache)

  bool natural() const { return colourIndex < 0; }
  /// One or more motions along the control of every natural clip, in their order.
  bool heldOut() const { return recipe && recipe->heldOut; }
};

/// The file of a recipe's model.
inline std::string modelFileOf(const SampleRecipe& recipe) {
  return (recipe.folder / recipe.system.model).string();
}

struct MotionId {
  int group = -1;  ///< MotionGroup::id
  int index = -1;  ///< in its motions
  auto operator<=>(const MotionId&) const = default;
};

/// What is lit up in every view at once.
struct Selection {
  std::set<MotionId> motions;
  std::optional<int> joint;
  bool operator==(const Selection&) const = default;
};

struct TimeRange {
  double beginS = 0.0, endS = 0.0;
  bool operator==(const TimeRange&) const = default;
};

struct FrameSpan {
  int first = 0, last = 0;  ///< last is outside; none inside where it is not above first
  bool empty() const { return first >= last; }
};

/// The frames of a clip inside a range of time, its ends included; all without a range.
inline FrameSpan framesIn(const Clip& clip, const std::optional<TimeRange>& range) {
  if (!range) return {0, clip.frameCount()};
  // A frame whose time is the range's own end is inside, whatever the rounding.
  constexpr double slack = 1e-9;
  return {std::max(0, static_cast<int>(std::ceil(range->beginS * clip.fps - slack))),
          std::min(clip.frameCount(),
                   static_cast<int>(std::floor(range->endS * clip.fps + slack)) + 1)};
}

}  // namespace marey

// The motions that plots compare: one set per group, as values that another thread may use.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/motions.h"
#include "render/base/colours.h"

namespace marey::gui {

struct MotionSet {
  int group = -1;
  std::string name;
  std::string system;  ///< empty: natural motion
  bool natural = false;
  render::Colour colour;
  bool dashed = false;  ///< a second set in the colour of another one
  std::vector<MotionId> ids;
  std::vector<ClipPtr> clips;     ///< one per id
  std::vector<RootFrame> wanted;  ///< the path that was asked for
  /// One per id where there is no single path: held-out motions follow the natural clips' control.
  std::vector<std::shared_ptr<const std::vector<RootFrame>>> wantedEach = {};
  /// For each motion the index of the natural clip whose control it follows; empty: the motions of
  /// a system all follow `wanted`, natural ones each their own.
  std::vector<int> follows = {};
  int all = 0;        ///< motions of the group
  int otherBody = 0;  ///< of these, used ones that have not the joints of `clips`
  const Skeleton& body() const { return *clips.front()->skeleton; }
};

/// One set per group: the motions that are used, shown or hidden, and that have the joints which
/// most of these have. Natural motion comes first. Motions that are being steered are left out.
/// Of held-out control: the motions along it instead of those along paths.
std::vector<MotionSet> motionSets(const std::vector<MotionGroup>& groups,
                                  Comparison comparison = Comparison::ThisPath);
const MotionSet* naturalSet(const std::vector<MotionSet>& sets);

/// The parts of a set's motions inside a range of time (all without one), by the rule of
/// framesIn; motions with nothing inside are left out.
struct ClipsInRange {
  std::vector<MotionId> ids;  ///< of every clip
  std::vector<Clip> clips;
  std::vector<std::vector<RootFrame>> wanted;  ///< of every clip; empty for natural motion
  std::vector<int> follows = {};               ///< of every clip, as in MotionSet; may be empty
};
ClipsInRange clipsIn(const MotionSet& set, const std::optional<TimeRange>& range);

/// "Counted: Natural 29 of 30 (1 of another skeleton), MG – circle 8 of 8"
std::string countedText(const std::vector<MotionSet>& sets);

/// Throws InputError unless `clip` has the joints of `first`, by name and parent.
void requireJointsOf(const Clip& clip, const Clip& first);

/// 0, 1 / fps, 2 / fps, ...
std::vector<double> framesInSeconds(size_t frames, double fps);

/// Median and 5 to 95 % over runs at every step; NaN are left out, and steps without a value.
struct Band {
  std::vector<double> step;  ///< index of the step
  std::vector<double> low, median, high;
};
Band bandOf(const std::vector<std::vector<double>>& runs);

}  // namespace marey::gui

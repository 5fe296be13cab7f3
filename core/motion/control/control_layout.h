// What the control of a model is made of: named channels, each a group of values per frame. Stored
// in every data set and model; what a motion is asked to do becomes rows of these values
// (encode_control.h).
#pragma once

#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

enum class ControlKind {
  RootMotion,  ///< sideways and forward displacement, metres, and turn, radians, of a frame
  FuturePath,  ///< ground points ahead, left and forward of the root frame, metres
  Label,       ///< one of several, one-hot, with interpolated transitions
  Skeleton,    ///< joints of the rest pose relative to the root joint, and its height, metres
  Array        ///< any signal, at the model's rate
};
/// "root_motion", "future_path", "label", "skeleton", "array".
std::string nameOf(ControlKind kind);

struct ControlChannel {
  std::string name = "root";
  ControlKind kind = ControlKind::RootMotion;
  /// May be left out. A last value then says whether it is there (1 or 0).
  bool optional = false;
  std::vector<double> aheadS = {};  ///< FuturePath: how far ahead its points lie, seconds
  /// Label: the labels. Array: names of its columns.
  std::vector<std::string> values = {};
  /// Label: how long a label takes to give way to the next one that follows at once, from the
  /// change on (Liu et al. 2021: 20 frames of 60 a second). Between labels with a gap, the gap.
  double transitionS = 1.0 / 3.0;
  bool fromNames = false;  ///< Label: a clip without labels has the one that its name holds
  int joints = 0;          ///< Skeleton
  double fps = 0.0;        ///< Array: rate of a signal that states none; 0: the clip's
  /// Array: past and future of the signal that stand in the row of a frame, seconds.
  double pastS = 0.0, futureS = 0.0;

  bool operator==(const ControlChannel&) const = default;
};

/// Root motion comes first: motion is rebuilt from it.
using ControlLayout = std::vector<ControlChannel>;

/// Where a channel stands in a row.
struct ControlColumns {
  const ControlChannel* channel = nullptr;
  int first = 0;
  int width = 0;      ///< its values
  int presence = -1;  ///< column that says whether it is there; -1: it always is

  int end() const { return first + width + (presence >= 0 ? 1 : 0); }
};

/// Of every channel in turn, in rows of a model of `fps` frames a second. The layout outlives it.
std::vector<ControlColumns> columnsOf(const ControlLayout& layout, double fps);
int widthOf(const ControlLayout& layout, double fps);
/// Frames of an Array's signal that stand in a row before and after the frame's own.
int pastFrames(const ControlChannel& channel, double fps);
int futureFrames(const ControlChannel& channel, double fps);

const ControlChannel* channelNamed(const ControlLayout& layout, const std::string& name);
/// The only channel of a kind that comes once (all but Array); null: there is none.
const ControlChannel* channelOf(const ControlLayout& layout, ControlKind kind);
/// Nothing but the root's motion.
bool isRootMotionAlone(const ControlLayout& layout);

/// Throws InputError naming `origin` unless root motion comes first and always, names differ, and
/// every channel has what its kind needs.
void validate(const ControlLayout& layout, const std::string& origin);
Json toJson(const ControlLayout& layout);
/// Strict. Throws InputError.
ControlLayout controlLayoutFromJson(const Json& value, const std::string& origin);

/// For people: "root motion; type: one of walk, run (may be left out)".
std::string summaryOf(const ControlLayout& layout);

}  // namespace marey

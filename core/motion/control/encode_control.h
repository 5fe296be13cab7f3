// What a motion is asked to do, as rows of control.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "motion/annotations.h"
#include "motion/features.h"

namespace marey {

/// What is asked beside the way. Time 0 is that of the first root frame.
struct ControlRequest {
  Annotations annotations;
  std::shared_ptr<const Skeleton> body;  ///< whose rest pose it is; null: none is known
  std::set<std::string> leftOut;         ///< channels that are left out although they are known

  bool operator==(const ControlRequest&) const = default;
};

/// What a clip's annotations, its name and `body` say.
ControlRequest requestOf(const Clip& clip, const FeatureSpec& spec,
                         std::shared_ptr<const Skeleton> body);

/// Rows [T, widthOf(layout)] of T root frames. What is left out is zero, with its presence (see
/// fillAbsent). The way goes on beyond its end as in its last frame. Throws InputError at `place`
/// where a channel that may not be left out is not asked for, a label is none of the channel's, or
/// a signal has other columns.
Matrix encodeControl(const ControlLayout& layout, const std::vector<RootFrame>& trajectory,
                     const ControlRequest& request, double fps, const Place& place);

/// Frames [T] of which a channel is there: all of one that may not be left out.
std::vector<bool> presenceOf(const ControlColumns& columns, const Matrix& control);
/// What is left out takes the mean [C] of a standardiser, which a model sees as zero.
void fillAbsent(const ControlLayout& layout, double fps, const std::vector<float>& mean,
                Matrix& control);

/// Weights [T, labels] of a label channel over time: one-hot, with transitions. Rows of frames that
/// have none are zero. Throws InputError for a label that is not the channel's.
Matrix labelWeights(const ControlChannel& channel, const std::vector<LabelSpan>& labels,
                    long frames, double fps, const Place& place);
/// The signal at the frames 0 .. T - 1 of another rate, [T, columns]: the mean over a frame's time
/// where that holds several rows, else linear between rows; ends go on.
Matrix signalAt(const Signal& signal, long frames, double fps);
/// The label that is a word of a clip's name, the longest of several; empty: none.
std::string labelInName(const ControlChannel& channel, const std::string& name);
/// 3 J + 1 values: joints of the rest pose relative to the root joint, and the height of that above
/// the lowest joint, metres.
std::vector<float> restPoseControl(const Skeleton& skeleton);

/// Rows of the body mirrored at its plane x = 0: labels, columns and joints of left and right are
/// swapped.
Matrix mirroredControl(const ControlLayout& layout, double fps, const Matrix& control,
                       const Skeleton& skeleton);
/// Rows backwards in time along `trajectory`, the root frames in their new order.
Matrix reversedControl(const ControlLayout& layout, double fps, const Matrix& control,
                       const std::vector<RootFrame>& trajectory);

}  // namespace marey

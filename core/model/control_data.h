// What the control of a data set takes from its clips. Internal to model.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "motion/control/encode_control.h"

namespace marey {

/// A layout with what it leaves to the clips: see prepareDataSet. Throws InputError.
ControlLayout completedLayout(ControlLayout layout, const std::vector<Clip>& clips);

/// The bodies of clips, where a body is a control.
class Bodies {
 public:
  Bodies(const std::vector<Clip>& train, const std::vector<Clip>& test, const FeatureSpec& spec);
  /// One skeleton for all clips of the same offsets; null where the body is no control.
  std::shared_ptr<const Skeleton> of(const Clip& clip) const;

 private:
  /// The skeleton of clips, and that which their features are of.
  std::vector<std::pair<std::shared_ptr<const Skeleton>, std::shared_ptr<const Skeleton>>> m_bodies;
};

struct Moments {
  std::vector<float> mean, std;
};
/// Population mean and standard deviation of columns. A constant column gets deviation 1, so
/// that standardising leaves it finite.
Moments poseMoments(const std::vector<FeatureSequence>& sequences);
/// The same of control, of the frames in which a channel is there; labels and presences stay as
/// they are (mean 0, deviation 1).
Moments controlMoments(const std::vector<FeatureSequence>& sequences, const FeatureSpec& spec);

}  // namespace marey

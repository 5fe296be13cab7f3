// Footsteps by a speed tolerance (Henter et al. 2020, Sec. 5.3): how many steps a motion seems to make
// when a foot counts as planted below a speed, for a sweep of speeds.
#pragma once

#include <string>
#include <vector>

#include "motion/clip.h"

namespace marey::stats {

struct FootstepOptions {
  std::vector<int> feet;  ///< joints: heels or ankles of a human, toes of a dog
  double stepCmS = 1.0;   ///< increment of the tolerance: 1.0 for a human, 0.3 for a dog
  double maximumCmS = 200.0;
};

/// Joint speed at frame t >= 1 is the horizontal distance from frame t-1 times the rate. A footstep
/// at tolerance v is a maximal run of frames with speed < v within one clip and one foot.
struct FootstepCurve {
  std::vector<double> toleranceCmS;
  /// f(v): footsteps of all clips and feet at each tolerance; of several samples per control, where
  /// each counts by its share, per control.
  std::vector<double> count;
  double maxCount = 0.0;
  double v95CmS = 0.0;         ///< first v with f(v) >= 0.95 max f; NaN where there is no step
  double durationMeanS = 0.0;  ///< of the steps at v95: frames of the run / rate
  double durationStdS = 0.0;   ///< population standard deviation
  double stepsPerS = 0.0;      ///< f(v95) / length of the motion: the step rate
  double lengthS = 0.0;        ///< of all clips, weighted as they are
};

/// A run of frames [firstFrame, lastFrame] in which a foot is slower than the tolerance.
struct ContactInterval {
  int joint = 0;
  int firstFrame = 0, lastFrame = 0;
  double seconds = 0.0;

  /// The first slow step starts at the frame before.
  double beginS(double fps) const { return (firstFrame - 1) / fps; }
  double endS(double fps) const { return lastFrame / fps; }
};

/// What counts as a contact wherever single contacts are shown: gait diagrams and floor marks.
struct ContactRule {
  double toleranceCmS = 25.0;
  std::string feet = {};  ///< as for feetOf

  bool operator==(const ContactRule&) const = default;
};

/// The feet of a skeleton by joint names ("Foot_L,Foot_R"), or those found by its naming habit
/// where `names` is empty. Throws InputError where there are none.
std::vector<int> feetOf(const Skeleton& skeleton, const std::string& names = {});

/// The joints of rules about toes: the child of each foot that is named a toe, else its only child,
/// else the foot itself (the toes of a quadruped, a skeleton that ends at the ankles).
std::vector<int> toesOf(const Skeleton& skeleton, const std::vector<int>& feet);

/// With `controls` (the number of every clip's control), f is per control: the mean over the clips
/// along each, summed over controls. Throws InputError on no clips, no feet, a foot that no joint
/// is, or a step that is not positive.
FootstepCurve footstepCurve(const std::vector<Clip>& clips, const FootstepOptions& options,
                            const std::vector<int>& controls = {});

/// Contacts of one clip at a tolerance, foot by foot in time order: the rows of a gait diagram.
std::vector<ContactInterval> contactIntervals(const Clip& clip, const std::vector<int>& feet,
                                              double toleranceCmS);
/// By a rule; none where the skeleton has no feet of its names.
std::vector<ContactInterval> contactIntervals(const Clip& clip, const ContactRule& rule);

/// Horizontal speeds of a joint in cm/s; entry t-1 is that of frame t (one less than frames).
std::vector<double> horizontalSpeedsCmS(const Clip& clip, int joint);

/// What one clip adds to every tolerance of a sweep; sums of clips give the curve of a set.
struct FootstepTally {
  /// By tolerance; empty: nothing.
  std::vector<double> count, seconds, squaredSeconds;
  double lengthS = 0.0;  ///< of the clip
};
std::vector<double> footstepTolerances(const FootstepOptions& options);
FootstepTally footstepTally(const Clip& clip, const FootstepOptions& options);
/// The curve of tallies counted `weights` times each (ControlSets::once for shares).
FootstepCurve curveOf(const std::vector<double>& tolerances,
                      const std::vector<FootstepTally>& tallies,
                      const std::vector<double>& weights);

}  // namespace marey::stats

// The pose and control features of Henter et al. 2020 (as in Habibie et al. 2017): poses in a
// floor-level frame that follows the character, and that frame's motion as control. What a pose is
// made of is its representation's (motion/representation/representation.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "motion/clip.h"
#include "motion/control/control_layout.h"
#include "motion/roles.h"

namespace marey {

/// Row-major: one row per frame.
using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How clips become features. Stored in every data set and model.
struct FeatureSpec {
  std::string layout = "root-positions";  ///< name of the representation
  double fps = 20.0;
  double rootSigmaS = 0.25;    ///< Gaussian filter of the root's floor position, seconds
  double facingSigmaS = 0.25;  ///< Gaussian filter of the facing direction, seconds
  ControlLayout control = {ControlChannel{}};

  int controlWidth() const { return widthOf(control, fps); }

  bool operator==(const FeatureSpec&) const = default;
};

/// The root frame on the floor: position, and heading about +Y (0 faces +Z, left is +X;
/// forward = (sin h, 0, cos h)).
struct RootFrame {
  double x = 0.0, z = 0.0, heading = 0.0;
};

/// One clip as a model sees it.
/// pose [T, D]: in the root frame, as the representation has it.
/// control [T, C]: as FeatureSpec::control has it. Its first three values are the root's sideways
/// (+left) and forward displacement in metres and its turn in radians since the previous frame, in
/// the previous root frame; there row 0 repeats row 1 (zero for a clip of one frame): it has no
/// previous frame.
struct FeatureSequence {
  std::string name;
  Matrix pose;
  Matrix control;
  RootFrame start;  ///< root frame of row 0
  /// Where rotations had to be fitted to positions: how far that moved a joint at most, metres.
  double fitM = 0.0;
  /// Whose poses they are, where that is another body than that of the data set or model; null:
  /// that.
  std::shared_ptr<const Skeleton> body = nullptr;

  int frameCount() const { return static_cast<int>(pose.rows()); }
};

/// Root frames of a clip at its own rate: hip position on the floor and facing (from the mean of
/// the left-right hip and shoulder vectors), both Gaussian-filtered in time.
/// Throws InputError when the skeleton has no left and right hip joint.
std::vector<RootFrame> rootTrajectory(const Clip& clip, const FeatureSpec& spec);
/// The same of a clip of any joints: one whose hips are not known by name faces where it moves to.
std::vector<RootFrame> rootPath(const Clip& clip, const FeatureSpec& spec);

/// Root motion [T, 3] between successive root frames, and back, of the first three values of
/// control, by integration in double.
Matrix controlFromTrajectory(const std::vector<RootFrame>& trajectory);
std::vector<RootFrame> trajectoryFromControl(const Matrix& control, const RootFrame& start);

/// Resamples to spec.fps and extracts pose and control, of which what the clip's annotations and
/// its name do not say is left out where it may be. Rotations are relative to the rest pose of
/// `skeleton`; null: of the clip's own. Throws InputError on invalid clips and unknown layouts, and
/// where control is missing that may not be left out.
FeatureSequence extractFeatures(const Clip& clip, const FeatureSpec& spec,
                                std::shared_ptr<const Skeleton> skeleton = nullptr);

/// World motion from features: the root follows the integrated control exactly.
Clip rebuildMotion(const Matrix& pose, const Matrix& control, const RootFrame& start,
                   std::shared_ptr<const Skeleton> skeleton, const FeatureSpec& spec);

/// Left and right swapped: the pose by its representation, sideways and turn negated.
FeatureSequence mirrored(const FeatureSequence& sequence, const FeatureSpec& spec,
                         const Skeleton& skeleton);
/// Backwards in time, controls negated.
FeatureSequence timeReversed(const FeatureSequence& sequence, const FeatureSpec& spec);

}  // namespace marey

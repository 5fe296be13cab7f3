// Log-likelihood of every frame of a clip under a model.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "model/clip_length.h"
#include "model/motion_model.h"

namespace marey {

/// Unit of a log-density of standardised poses: where one asks for it, and of models without a
/// standardiser.
inline constexpr const char* kStandardisedUnit = "nats per frame, standardised poses";

struct ClipScore {
  std::string name;
  int frames = 0;                  ///< of the clip, at the model's rate
  int firstFrame = 0;              ///< first scored frame, at the model's rate
  std::string unit;                ///< of the numbers: likelihoodUnit, or kStandardisedUnit
  std::vector<double> loglikNats;  ///< per frame, in `unit`
  std::vector<double> latentNorm;  ///< |z| per frame
  /// The yardstick's of the same frames, in the same unit; empty for models without one.
  std::vector<double> linearGaussianNats;
  /// Of the same frames: the joint that the others explain least, by the yardstick; empty without
  /// one, or where the values of a pose are not the positions of joints.
  std::vector<int> oddestJoint;
  double bitsPerDimension = 0.0;    ///< mean, -log2 p / D
  double meanNatsPerFrame() const;  ///< NaN where nothing was scored
  /// All of it is context: it has no frame to score. Nothing is scored of long clips either where
  /// the model has no likelihood (ModelInfo::density).
  bool tooShort() const { return frames <= firstFrame; }
};

/// Why a clip cannot be scored with others under a model: its joints are not the model's. Empty: it
/// can.
std::string whyNotScored(const ModelInfo& info, const Clip& clip);

/// Scores of many sequences, which advance together where the model can; a sequence's score does
/// not depend on the others. Those too short (fewestFrames) are left empty, for the caller to count
/// and name; scoring one alone refuses it. Throws CancelledError within a
/// frame's time.
std::vector<ClipScore> scoreSequences(const MotionModel& model,
                                      std::span<const FeatureSequence> sequences, bool standardised,
                                      Progress& progress);
/// The same for clips, as scoreClip does.
std::vector<ClipScore> scoreClips(const MotionModel& model, std::span<const Clip> clips,
                                  bool standardised, Progress& progress);

/// Scores features: what a sampled motion was made of, with the control that it
/// was given. Throws InputError when the sequence is not longer than the model's context.
ClipScore scoreSequence(const MotionModel& model, const FeatureSequence& features,
                        bool standardised = false);

/// The clip's first `context` frames are history; the others are scored from a running state
/// that starts at zero; where the model has observation noise, the mean over its draws
/// (model/observation.h). `standardised` leaves the standardiser's log-determinant out.
/// Throws InputError when the clip is too short or of another skeleton.
ClipScore scoreClip(const MotionModel& model, const Clip& clip, bool standardised = false);

}  // namespace marey

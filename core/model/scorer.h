// Log-likelihood of every frame of a clip under a model.
#pragma once

#include <span>
#include <vector>

#include "base/job.h"
#include "model/motion_model.h"

namespace marey {

struct ClipScore {
  std::string name;
  int firstFrame = 0;              ///< first scored frame, at the model's rate
  std::vector<double> loglikNats;  ///< per frame, standardiser's log-determinant included
                                   ///< unless asked for the standardised density
  std::vector<double> latentNorm;  ///< |z| per frame
  double bitsPerDimension = 0.0;   ///< mean, -log2 p / D
  double meanNatsPerFrame() const;
};

/// Scores of many sequences, which advance together where the model can; a sequence's score does
/// not depend on the others. Throws as scoreSequence; CancelledError within a frame's time.
std::vector<ClipScore> scoreSequences(const MotionModel& model,
                                      std::span<const FeatureSequence> sequences, bool standardised,
                                      Progress& progress);
/// The same for clips, as scoreClip does.
std::vector<ClipScore> scoreClips(const MotionModel& model, std::span<const Clip> clips,
                                  bool standardised, Progress& progress);

/// Scores features as they are: what a sampled motion was made of, with the control that it
/// was given. Throws InputError when the sequence is not longer than the model's context.
ClipScore scoreSequence(const MotionModel& model, const FeatureSequence& features,
                        bool standardised = false);

/// The clip's first `context` frames are history; the others are scored from a running state
/// that starts at zero. `standardised` leaves the standardiser's log-determinant out.
/// Throws InputError when the clip is too short or of another skeleton.
ClipScore scoreClip(const MotionModel& model, const Clip& clip, bool standardised = false);

}  // namespace marey

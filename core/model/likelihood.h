// What is said of a model's log-likelihood of some clips: one set of definitions for the command
// line, the report and the window. The unit is that of the scores.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/scorer.h"

namespace marey {

/// Directions of pose space in which at least half of a model's variance is its observation floor,
/// in the mean over some training frames; NaN for models without a floor.
double floorDirectionsOf(const ModelInfo& info);

struct ShortClip {
  std::string name;
  int frames = 0, needed = 0;
};

struct LikelihoodSummary {
  int clips = 0;
  long frames = 0;
  std::string unit = {};  ///< of the scores; without any, the model's
  int firstFrame = 0;     ///< scored frames start here in every clip
  double nats = 0.0;      ///< mean over frames; NaN without frames, or where the model has none
  double linearGaussian = 0.0;  ///< of the same frames; NaN for models without a yardstick
  double floorDirections = 0.0, effectiveDimensions = 0.0;  ///< NaN without a floor
  double natsPerEffectiveDimension = 0.0;                   ///< NaN without a floor
  std::vector<ShortClip> tooShort;
};

/// Over the frames from `firstFrame` on: the largest context of the models that are compared.
/// Clips without such a frame are named.
LikelihoodSummary summarise(const ModelInfo& info, std::span<const ClipScore> scores,
                            int firstFrame);

/// "2 of 24 clips are too short to score (fewer than 11 frames): a, b"; empty without any.
std::string tooShortText(const LikelihoodSummary& summary);

/// What the number hangs on, in a sentence or two.
std::string floorText(const ModelInfo& info);

}  // namespace marey

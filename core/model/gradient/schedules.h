// What changes over a training: the learning rate, and how often a net is fed its own output. Pure
// functions of the step, so that a resumed run has what an unbroken one would.
#pragma once

#include "model/gradient/training_config.h"

namespace marey {

/// Of the step that follows `step` finished ones. `windows`: of the training data, which are an
/// epoch together.
///
/// fixed; noam (Vaswani et al. 2017) rises over the warm-up and falls as 1 / sqrt(step); cosine and
/// linear rise over the warm-up and fall to the minimum at the planned end; step is multiplied by
/// `decayFactor` every so many steps or whole epochs.
double learningRateAt(const TrainingConfig& config, int64_t step, int64_t windows);

/// How likely a frame's pose is the net's own instead of the data's, as the next frame sees it
/// (Bengio et al. 2015, with a linear schedule).
double ownOutputShareAt(const ScheduledSampling& sampling, int64_t step);

}  // namespace marey

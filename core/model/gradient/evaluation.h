// The loss of windows that training does not see. Internal (libtorch types).
#pragma once

#include "model/gradient/batches.h"
#include "model/gradient/training_noise.h"
#include "nn/processes/process_group.h"

namespace marey {

/// Mean over all windows in the objective's unit, under fixed noise; NaN where nothing counts.
/// Every process takes some of the windows and gets the whole mean.
double meanLoss(TrainableModel& net, const Batches& batches, const TrainingNoise& noise,
                nn::ProcessGroup& group);

}  // namespace marey

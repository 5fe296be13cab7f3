// What becomes of the inputs of the nets in training, as the configuration asks: Gaussian noise,
// values that are hidden, and own poses in place of the data's. Internal (libtorch types).
#pragma once

#include "model/gradient/trainable.h"
#include "model/gradient/training_config.h"

namespace marey {

/// Changes what a batch says of control and past poses; the poses to be foreseen stay. Everything
/// is drawn on the CPU from `generator`, so that a device changes no batch; nothing where nothing
/// is asked for.
void disturbInputs(const TrainingConfig& config, at::Generator& generator, TrainingBatch& batch);

/// Throws InputError naming `origin` where the configuration asks for what the net cannot do.
void requireSuitedInputs(const TrainingConfig& config, const TrainableModel& net,
                         const std::string& origin);

}  // namespace marey

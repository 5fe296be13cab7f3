// A data set as training sees it. Internal (libtorch types).
#pragma once

#include <memory>
#include <optional>

#include "model/gradient/batches.h"
#include "model/gradient/training_config.h"
#include "model/gradient/training_noise.h"
#include "model/linear_gaussian.h"
#include "model/training_pace.h"

namespace marey {

struct TrainingData {
  Batches train;
  std::optional<Batches> valid, test;  ///< none without such clips; windows of 400 scored frames
  TrainingNoise noise;
  TrainingPace pace;
  std::shared_ptr<const LinearGaussian> yardstick;  ///< null for models without a floor

  /// For data-dependent starts.
  TrainingFrames framesFor(const TrainableModel& net) const;
};

/// Throws InputError naming `origin` where windows are no longer than what the model sees.
TrainingData trainingDataOf(const DataSet& data, const TrainingConfig& config,
                            const TrainableModel& net, torch::Device device,
                            const std::string& origin);

}  // namespace marey

// The "training" object of a configuration.
#pragma once

#include <cstdint>
#include <string>

#include "base/json.h"

namespace marey {

struct TrainingConfig {
  double windowS = 4.0, hopS = 2.0;
  int batch = 100;     ///< windows of a step
  int accumulate = 1;  ///< parts of a batch that go one after the other: less memory, same step
  double learningRate = 1e-4;
  std::string schedule = "fixed";  ///< fixed, noam, cosine
  int64_t warmupSteps = 1000;
  double minimumRate = 1e-5;                 ///< floor of noam and cosine
  double clipValue = 5.0, clipNorm = 100.0;  ///< 0: off
  double ema = 0.0;                          ///< decay of the averaged weights; 0: off
  int64_t steps = 100000;                    ///< the run's planned end (and the cosine's)
  int64_t checkpointEvery = 100;             ///< steps between checkpoints (and validations)
  double validationShare = 0.05;             ///< of the training clips, left out of training
  double snapshotMinutes = 10.0;             ///< a checkpoint is kept for good this often; 0: never
  int keep = 8;             ///< checkpoints kept evenly over the run, to be compared; 0: none
  bool useReversed = true;  ///< train on time-reversed clips too, where the data has them
};
TrainingConfig trainingConfigFromJson(const Json& value, const std::string& origin);
Json toJson(const TrainingConfig& config);
/// Of the step that follows `step` finished ones, by the configuration's schedule.
double learningRateAt(const TrainingConfig& config, int64_t step);

}  // namespace marey

// The "training" object of a configuration.
#pragma once

#include <cstdint>
#include <string>

#include "base/json.h"

namespace marey {

/// How often a net that sees its own past poses is fed those that it made instead of the data's:
/// the share goes from `from` to `to` between two steps, and stays there.
struct ScheduledSampling {
  double from = 0.0, to = 0.0;
  int64_t beginStep = 0, endStep = 1;
  bool none() const { return from == 0.0 && to == 0.0; }
};

struct TrainingConfig {
  double windowS = 4.0, hopS = 2.0;
  int batch = 100;     ///< windows of a step
  int accumulate = 1;  ///< parts of a batch that go one after the other: less memory, same step
  std::string optimiser = "adam";  ///< adam, rmsprop
  double rmsDecay = 0.99;          ///< rmsprop: of the mean square of gradients
  double learningRate = 1e-4;
  std::string schedule = "fixed";  ///< fixed, noam, cosine, linear, step (schedules.h)
  int64_t warmupSteps = 1000;
  double minimumRate = 1e-5;                 ///< floor of all schedules but the fixed one
  int64_t decayEverySteps = 0;               ///< step: either of the two; 0: the other
  int64_t decayEveryEpochs = 0;              ///< windows of the data seen once
  double decayFactor = 0.5;                  ///< step
  double clipValue = 5.0, clipNorm = 100.0;  ///< 0: off
  /// Of Gaussian noise on every value that the nets are given (control and past poses), in standard
  /// deviations of the data; what is to be foreseen stays as it is.
  double inputNoise = 0.0;
  /// Share of those values that are hidden: the mean of the data in their place (Vincent et al.
  /// 2008).
  double inputDropout = 0.0;
  /// Share of the windows of a step in which a control that may be left out is, each on its own.
  double controlDropout = 0.25;
  ScheduledSampling scheduledSampling;
  double ema = 0.0;               ///< decay of the averaged weights; 0: off
  int64_t steps = 100000;         ///< the run's planned end (and that of cosine and linear)
  int64_t checkpointEvery = 100;  ///< steps between checkpoints (and validations)
  double validationShare = 0.05;  ///< of the training clips, left out of training
  double snapshotMinutes = 10.0;  ///< a checkpoint is kept for good this often; 0: never
  int keep = 8;                   ///< checkpoints kept evenly over the run, to be compared; 0: none
  bool useReversed = true;        ///< train on time-reversed clips too, where the data has them
};
/// Strict: throws InputError for unknown keys, values out of range, and keys that have no effect
/// beside the others.
TrainingConfig trainingConfigFromJson(const Json& value, const std::string& origin);
/// Without what has no effect.
Json toJson(const TrainingConfig& config);
/// What a run that goes on must have in common with how it began: it may be longer, and use less
/// memory or disk.
Json identityOf(const TrainingConfig& config);

}  // namespace marey

// Maximum-likelihood training with checkpoints from which a broken run goes on exactly.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/job.h"
#include "model/data_set.h"

namespace marey {

/// The "training" object of a configuration.
struct TrainingConfig {
  double windowS = 4.0, hopS = 2.0;
  int batch = 100;
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
  bool useReversed = true;  ///< train on time-reversed clips too, where the data has them
};
TrainingConfig trainingConfigFromJson(const Json& value, const std::string& origin);
Json toJson(const TrainingConfig& config);
/// Of the step that follows `step` finished ones, by the configuration's schedule.
double learningRateAt(const TrainingConfig& config, int64_t step);

struct TrainRequest {
  Json config;  ///< {"family", "name", "model", "training"}
  std::string configOrigin;
  std::filesystem::path run;      ///< folder of the run
  std::optional<int64_t> steps;   ///< end at this step
  std::optional<double> minutes;  ///< end after this much training time, earlier runs included
  bool resume = false;
  std::filesystem::path init;  ///< model to take weights from; empty: random start
  std::string device = "cpu";  ///< cpu, cuda
  uint64_t seed = 1;
  std::string command;  ///< for the model's provenance
};

struct TrainResult {
  int64_t steps = 0;
  double trainBitsPerFrame = 0.0;  ///< standardised poses, mean since the last checkpoint
  double validBitsPerFrame = 0.0;  ///< of the best checkpoint
  double testNatsPerFrame = 0.0;   ///< held-out clips, poses in metres, at the end
  std::filesystem::path best, last;
};

/// Writes into the run's folder: config.json, log.csv, last.marey (model), best.marey (by
/// validation), state.marey (optimiser and counters), snapshots/. Resuming needs the same data
/// and configuration, and then gives the same batches and numbers as an unbroken run.
/// Throws InputError (also for data that are not finite), FileError, CancelledError (after writing
/// a checkpoint) and NumericError naming the layer after five non-finite steps in a row.
TrainResult train(const DataSet& data, const TrainRequest& request,
                  std::span<const ModelFamily> families, Progress& progress);

}  // namespace marey

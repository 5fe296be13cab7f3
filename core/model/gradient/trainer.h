// Training by gradient, with checkpoints from which a broken run goes on exactly.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "base/job.h"
#include "base/process_rank.h"
#include "model/data_set.h"
#include "model/gradient/objective.h"
#include "model/gradient/training_config.h"
#include "model/model_family.h"

namespace marey {

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
  /// Which of several processes this is, all of which train the same model on parts of the same
  /// batches. The first one alone writes files.
  ProcessRank process;
  Execution execution = Execution::Engine;  ///< the reference: the plain libtorch path
};

struct TrainResult {
  int64_t steps = 0;  ///< 0 where a family builds its models without any
  Objective objective;
  /// Losses in shownUnit(objective); NaN where there is none.
  double train = std::numeric_limits<double>::quiet_NaN();  ///< mean since the last checkpoint
  double valid = std::numeric_limits<double>::quiet_NaN();  ///< of the best checkpoint
  /// Held-out clips at the end, in testUnit; NaN unless the objective is a likelihood.
  double testNatsPerFrame = std::numeric_limits<double>::quiet_NaN();
  std::string testUnit = {};  ///< likelihoodUnit
  std::filesystem::path best, last;
};

/// Writes into the run's folder: config.json, log.csv, last.marey (model), best.marey (by
/// validation), state.marey (optimiser and counters), checkpoints/ (the last `training.keep` of an
/// even spread, their figures in log.csv), snapshots/ (kept for good). Resuming needs the same data
/// and configuration, and then gives the same batches and numbers as an unbroken run.
/// Throws InputError (also for data that are not finite), FileError, CancelledError (after writing
/// a checkpoint) and NumericError naming the layer after five non-finite steps in a row.
TrainResult trainByGradient(const DataSet& data, const TrainRequest& request,
                            const ModelFamily& family, Progress& progress);

}  // namespace marey

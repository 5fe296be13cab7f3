// A folder of a training run: its log and the models it left.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace marey {

/// A row of log.csv; losses in the run's unit, NaN where there was nothing to measure.
struct LossRow {
  int64_t step = 0;
  double seconds = 0.0;
  double train = 0.0, valid = 0.0, test = 0.0;
};

struct Checkpoint {
  std::string name;  ///< "step 480", "best (step 2300)", "last (step 2634)"
  std::string file;
  int64_t step = 0;
};

struct TrainingRun {
  std::string unit;  ///< of losses: "bits per frame"
  std::vector<LossRow> rows;
  std::vector<Checkpoint> checkpoints;  ///< snapshots by their step, then best and last
};

/// Throws FileError, or InputError naming the line of a log that is none.
TrainingRun readTrainingRun(const std::filesystem::path& folder);

/// Where a checkpoint stands among those of its run by its step: 0 for the first, 1 for the last.
double stageOf(const TrainingRun& run, const Checkpoint& checkpoint);

}  // namespace marey

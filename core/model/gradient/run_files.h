// The files of a training run that are not models: what it was asked for, and its log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace marey {

/// One line of log.csv; NaN where there is no value.
struct LogRow {
  int64_t step = 0;
  double seconds = 0.0, learningRate = 0.0;
  double train = 0.0, valid = 0.0, test = 0.0;  ///< losses in the log's unit
  double gradientNorm = 0.0;
  int64_t skipped = 0;                                     ///< steps since the last row
  std::vector<std::pair<std::string, double>> terms = {};  ///< of the training loss
};

/// The columns of losses are named after their unit: train_bits_per_frame, ...; `terms` after them.
void startLog(const std::filesystem::path& run, const std::string& unit,
              const std::vector<std::string>& terms);
/// Throws FileError.
void appendLog(const std::filesystem::path& run, const LogRow& row);
/// Drops rows after `step`, which a killed run wrote after its last state.
void cutLog(const std::filesystem::path& run, int64_t step);

}  // namespace marey

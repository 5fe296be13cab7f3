// The files of a training run that are not models: what it was asked for, and its log.
#pragma once

#include <filesystem>

#include "base/json.h"

namespace marey {

/// One line of log.csv; NaN where there is no value.
struct LogRow {
  int64_t step = 0;
  double seconds = 0.0, learningRate = 0.0;
  double trainBits = 0.0, validBits = 0.0, testBits = 0.0;  ///< per frame
  double gradientNorm = 0.0;
  int64_t skipped = 0;  ///< steps since the last row
};

void startLog(const std::filesystem::path& run);
/// Throws FileError.
void appendLog(const std::filesystem::path& run, const LogRow& row);
/// Drops rows after `step`, which a killed run wrote after its last state.
void cutLog(const std::filesystem::path& run, int64_t step);

}  // namespace marey

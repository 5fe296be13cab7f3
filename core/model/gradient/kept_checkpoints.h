// Checkpoints that a training run keeps beside the best and the last one, so that its stages can be
// compared: evenly spread over the run and never more than asked for, however long it becomes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "model/gradient/training_config.h"

namespace marey {

/// Of checkpoints 1, 2, 3, ... `count`, every how many are kept: the smallest power of two that
/// leaves `keep` or fewer of them (and then more than half as many). keep >= 1.
int64_t keptEvery(int64_t count, int keep);

/// Writes `model` as checkpoints/step_NNNNNNN.marey where its step is one to keep, and removes
/// those that now stand too close. What stays depends on the step alone, so that a resumed run
/// keeps what an unbroken one would. Throws FileError.
void keepCheckpoint(const std::filesystem::path& run, const TrainingConfig& config, int64_t step,
                    std::string_view model);

}  // namespace marey

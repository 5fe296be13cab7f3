// Sampled motions as files, by any number of processes: the same bytes whatever their number, in
// memory that does not grow with the number of motions.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/ranks.h"
#include "base/unfinished_folder.h"
#include "model/sampler.h"
#include "motion/skeleton_fit.h"

namespace marey {

struct SampleFilesRequest {
  SampleRequest sampling;  ///< `samples` in all, from number 0
  std::filesystem::path out;
  std::string format;
  Json recipe;          ///< of every file, where its number is added under "sample"
  int writers = 1;      ///< threads that fit rotations and write
  bool resume = false;  ///< goes on with a broken run of the same recipe and number
};

struct SampleFiles {
  std::vector<std::string> clips;  ///< the motions' files, in order
  std::optional<FitResidual> fit;  ///< of all motions, where rotations were fitted
  int sampled = 0;                 ///< motions that this run made: a resumed one makes what lacked
};

/// Motions that one record of an unfinished folder stands for.
constexpr int kMotionsOfPart = 16;
/// Motions that are sampled together: fewer where they are long, so that what is held stays small.
int motionsTogether(const ModelInfo& info, size_t frames);

/// Writes sample_000.FORMAT, ... into `out`, whole or not at all: see UnfinishedFolder, which is
/// handed to `opened` at the first rank. Full result at the first rank only. Throws UsageError,
/// InputError, FileError, NumericError, CancelledError.
SampleFiles writeSampleFiles(const MotionModel& model, const SampleFilesRequest& request,
                             Ranks& ranks, Progress& progress,
                             const std::function<void(const UnfinishedFolder&)>& opened = {});

}  // namespace marey

// Statistics of many files, dealt out over processes and read as they are needed: memory does not
// grow with the length of clips, and results do not depend on the number of processes.
#pragma once

#include <string>
#include <vector>

#include "base/ranks.h"
#include "experiment/comparison.h"
#include "io/input_report.h"
#include "stats/statistic.h"

namespace marey {

struct ClipFiles {
  std::vector<io::InputFile> files;
  io::ReadOptions read;
  double fps = 0.0;  ///< clips are resampled to it; 0: the rate of the first one
};

/// Which clips follow one control: each its own, those of one folder the same, or all the same.
enum class ControlRule { Each, Folder, One };

struct ClipStatisticsRequest {
  ClipFiles clips, natural;  ///< natural.files empty: none
  ControlRule controls = ControlRule::Each;
  /// Of the natural files, by their names: those of SameControl have the name of a clip's file, and
  /// are drawn with it as a pair; those of SameStyle have its style (comparison.h).
  NaturalChoice against = NaturalChoice::All;
  std::string feet;          ///< names of joints, "A,B"; empty: found by their names
  double footStepCmS = 0.0;  ///< 0: 1.0, of quadrupeds 0.3
  stats::EvaluationOptions options;
};

struct ClipStatistics {
  std::shared_ptr<const Skeleton> skeleton;  ///< of the first clip
  double fps = 0.0, seconds = 0.0;
  size_t clips = 0;
  bool compared = false;
  std::string comparedWith;  ///< "all 101 natural clips"; by file
  std::vector<int> feet;
  std::optional<stats::FootstepCurve> footsteps;  ///< none without feet
  std::vector<stats::StatisticResult> results;
  io::InputReport inputs;  ///< doubts of the clips of both sets, files found that cannot be read
};

/// Files are read twice where they are many: once for what the set says as a whole, once for what
/// each clip adds. Whole at the first rank only. Throws InputError, FileError, UsageError,
/// CancelledError.
ClipStatistics clipStatistics(const ClipStatisticsRequest& request, Ranks& ranks,
                              Progress& progress);

}  // namespace marey

// Tasks of an experiment, done by a system and judged by the natural clips.
#pragma once

#include <string>
#include <vector>

#include "task/pose_error.h"

#include "base/ranks.h"
#include "experiment/experiment_case.h"
#include "motion/clip.h"

namespace marey {

/// What one system made of a case.
struct CaseResult {
  std::string whyNot;              ///< why the system cannot do it; empty: it can
  std::vector<PoseError> errors;   ///< one for every clip that could be used
  std::vector<PoseError> without;  ///< of the same clips: without a model (TaskOutcome::without)
  int leftOut = 0;                 ///< clips that are too short
};

/// Throws InputError, NumericError and CancelledError. Whole at the first rank alone.
CaseResult runCase(const MotionModel& model, const ExperimentCase& experimentCase,
                   const std::vector<Clip>& natural, uint64_t seed, const ExperimentSystem& system,
                   Progress& progress, Ranks& ranks);

}  // namespace marey

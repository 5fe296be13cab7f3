// A task of an experiment: what every system is asked to do with the natural clips.
#pragma once

#include <map>
#include <string>

#include "task/task.h"

#include "base/json.h"
#include "experiment/parts.h"

namespace marey {

/// One task with its options, on every natural clip.
struct ExperimentCase {
  std::string name;
  std::string task;                       ///< of a task that takes clips
  std::map<std::string, double> options;  ///< by TaskOption::name
  int samples = 1;                        ///< for each clip
  bool operator==(const ExperimentCase&) const = default;
};

/// Strict: throws InputError naming `prefix` and the key, also for options that the task has not.
ExperimentCase caseFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix);
Json toJson(const ExperimentCase& experimentCase);

/// What the task is asked for; the clip is to follow.
TaskRequest requestOf(const ExperimentCase& experimentCase, uint64_t seed,
                      const ExperimentSystem& system);

}  // namespace marey

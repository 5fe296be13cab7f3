// What a model is asked to do: one explicit list. A task says which abilities it needs, takes its
// request as data and gives motions, with what they are to be judged by where there is something.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "model/sampler.h"

namespace marey {

/// Of any task; each reads what concerns it.
struct TaskRequest {
  std::optional<Clip> clip;  ///< that is gone on with, completed or denoised, at any rate
  /// Root frames at the model's rate. predict: where to go after the seed frames, from the root
  /// frame of the last of them (placed there, whatever its own place); empty: the clip's own
  /// control.
  std::vector<RootFrame> path;
  int samples = 1;
  uint64_t seed = 1;
  double temperature = 1.0;
  double warmUpS = 1.0;  ///< follow: generated before the first frame and dropped
  int seedFrames = 0;    ///< predict: frames that are given, at the model's rate; 0: the context
  double seconds = 0.0;  ///< predict along the clip's own control: at most so long; 0: all of it
  /// complete: [frames at the model's rate, joints], 1 where a joint is known, else 0.
  Matrix knownJoints;
};

struct TaskOutcome {
  std::vector<Clip> motions;
  /// What really came, frame by frame beside every motion; none where nobody knows.
  std::optional<Clip> reference;
};

struct Task {
  std::string name;   ///< "predict": of its command and key
  std::string title;  ///< one line for people
  /// Why a model cannot do it; empty: it can.
  std::function<std::string(const MotionModel&)> whyNot;
  /// Throws InputError (also where whyNot says something), NumericError and CancelledError.
  std::function<TaskOutcome(const MotionModel&, const TaskRequest&, Progress&)> run;
};

std::span<const Task> tasks();
/// Throws InputError.
const Task& taskNamed(const std::string& name);

/// run, once the model is known to be able to.
TaskOutcome runTask(const Task& task, const MotionModel& model, const TaskRequest& request,
                    Progress& progress);

}  // namespace marey

// What a model is asked to do: one explicit list. A task says which abilities it needs, takes its
// request as data and gives motions, with what they are to be judged by where there is something.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "task/steering.h"

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
  /// Beside `path`; with the clip's own control, only what is left out of it.
  ControlRequest control = {};
  int samples = 1;
  uint64_t seed = 1;
  double temperature = 1.0;
  OptionValues options;  ///< of the model's optionSchema, beside the temperature
  double warmUpS = 1.0;  ///< follow: generated before the first frame and dropped
  int seedFrames = 0;    ///< predict: frames that are given, at the model's rate; 0: the context
  double seconds = 0.0;  ///< predict along the clip's own control: at most so long; 0: all of it
  /// complete: [frames at the model's rate, joints], 1 where a joint is known, else 0.
  Matrix knownJoints;
  /// complete, without knownJoints: share of the joints of every frame that is hidden at random.
  double missing = 0.0;
  double noiseM = 0.0;  ///< denoise: deviation of the noise that is added to the clip first, metres
  double levelM = 0.0;  ///< denoise: deviation of the noise that is taken out; 0: noiseM
  std::optional<Steering> steering;  ///< steer; its seed and temperature are those above
};

struct TaskOutcome {
  std::vector<Clip> motions;
  /// What really came, frame by frame beside every motion; none where nobody knows.
  std::optional<Clip> reference;
  /// What one would have without a model: the last seed frame held, joints that are missing held,
  /// the noise left in. None where there is no reference.
  std::optional<Clip> without;
};

/// What a task takes besides model, clips and samples: an option of its command (--seed-frames) and
/// a key of a document's case ("seed_frames").
struct TaskOption {
  std::string name;  ///< with underscores
  std::string help;
  double least = 0.0;
  bool whole = false;                                ///< whole numbers only
  std::function<void(TaskRequest&, double)> number;  ///< or:
  std::function<void(TaskRequest&, Matrix)> table;   ///< numbers of a CSV or NPY file
};

struct Task {
  enum class From {
    Path,      ///< a path; the sampler's own command draws it
    Clips,     ///< a clip each
    Commands,  ///< steering: a command for every frame
  };

  std::string name;     ///< "predict": of its command and key
  std::string title;    ///< one line for people
  std::string done;     ///< "continued": what has become of its clips
  std::string without;  ///< what TaskOutcome::without is; empty: nothing
  std::string example;  ///< words after `marey NAME MODEL`
  From from = From::Clips;
  bool takesPath = false;  ///< beside clips: where to go in place of their own control
  std::vector<TaskOption> options;
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

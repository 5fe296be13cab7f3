// Follow commands as they come, frame by frame.
#include "task/live_rollout.h"
#include "task/task_list.h"

#include "base/error.h"

namespace marey {
namespace {

std::string whyNot(const MotionModel& model) {
  if (!model.info().skeleton) return "one without a skeleton";
  return model.rollout() ? "" : "one that needs all control first";
}

TaskOutcome run(const MotionModel& model, const TaskRequest& r, Progress& progress) {
  if (!r.steering) throw InputError({.path = "steer"}, "commands", "none");
  // The model outlives the rollouts, which end here.
  const std::shared_ptr<const MotionModel> borrowed(std::shared_ptr<const MotionModel>(), &model);
  TaskOutcome out;
  for (int sample = 0; sample < r.samples; ++sample) {
    LiveOptions options = r.steering->options;
    options.seed = r.seed;
    options.temperature = r.temperature;
    options.options = r.options;
    options.sample += sample;
    LiveRollout rollout(borrowed, options);
    for (const LiveCommand& command : r.steering->commands) {
      progress.throwIfCancelled();
      rollout.advance(command);
    }
    FeatureSequence sequence = rollout.sequence();
    sequence.name = fmt::format("sample_{:03}", options.sample);
    out.motions.push_back(sampledClip(model, sequence));
    progress.report((sample + 1.0) / r.samples, "steering");
  }
  return out;
}

}  // namespace

Task steerTask() {
  return {.name = "steer",
          .title = "follow commands as they come, frame by frame",
          .done = "steered",
          .without = "",
          .example = "commands.csv -n 3 --out steered",
          .from = Task::From::Commands,
          .options = {},
          .whyNot = whyNot,
          .run = run};
}

}  // namespace marey

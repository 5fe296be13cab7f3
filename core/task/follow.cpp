// Follow a path from the mean pose.
#include "task/task_list.h"

#include "base/error.h"

namespace marey {
namespace {

std::string whyNot(const MotionModel& model) {
  const ModelInfo& info = model.info();
  if (!info.skeleton) return "one without a skeleton";
  return model.rollout() || model.wholeClip() ? "" : "one that does not make motion along a path";
}

TaskOutcome run(const MotionModel& model, const TaskRequest& r, Progress& progress) {
  SampleRequest request{.path = r.path,
                        .control = r.control,
                        .samples = r.samples,
                        .seed = r.seed,
                        .temperature = r.temperature,
                        .options = r.options,
                        .warmUpS = r.warmUpS};
  if (request.path.empty() && r.clip) {
    SampleRequest along = requestAlongClip(model, *r.clip, false);
    request.path = std::move(along.path);
    request.control = std::move(along.control);
    request.control.leftOut = r.control.leftOut;
  }
  return {.motions = sampleClips(model, request, progress), .reference = {}, .without = {}};
}

}  // namespace

Task followTask() {
  return {.name = "follow",
          .title = "make motion that goes along a path",
          .done = "made",
          .without = "",
          .example = "--path preset:circle --out samples",
          .from = Task::From::Path,
          .options = {},
          .whyNot = whyNot,
          .run = run};
}

}  // namespace marey

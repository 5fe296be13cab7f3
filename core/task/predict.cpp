// Go on with a motion of which the first frames are given.
#include <algorithm>
#include <cmath>

#include "task/task_list.h"

#include "base/error.h"

namespace marey {
namespace {

std::string whyNot(const MotionModel& model) {
  const ModelInfo& info = model.info();
  if (!info.skeleton) return "one without a skeleton";
  if (!model.rollout()) return "one that does not make motion frame by frame";
  return info.context > 0 ? "" : "one that sees no past poses";
}

/// The path with its first frame at `place`.
std::vector<RootFrame> placedAt(const std::vector<RootFrame>& path, const RootFrame& place) {
  return trajectoryFromControl(controlFromTrajectory(path), place);
}

int seedFramesOf(const TaskRequest& r, const ModelInfo& info, const FeatureSequence& features) {
  const int frames = features.frameCount(), seed = r.seedFrames > 0 ? r.seedFrames : info.context;
  const Place place{.path = features.name, .item = "seed frames"};
  if (seed < info.context)
    throwInput(place, fmt::format("at least the {} frames that the model sees", info.context), "{}",
               seed);
  const int after = r.path.empty() ? 2 : 0;  // the control of one frame needs two root frames
  if (frames < seed + after)
    throwInput(place,
               fmt::format("fewer than the clip's {} frames at {} per second, with some to come",
                           frames, info.features.fps),
               "{}", seed);
  return seed;
}

TaskOutcome run(const MotionModel& model, const TaskRequest& r, Progress& progress) {
  const ModelInfo& info = model.info();
  if (!r.clip) throw InputError({.path = "predict"}, "a clip to go on with", "none");
  const std::string& path = r.clip->source.path.empty() ? r.clip->name : r.clip->source.path;
  requireSameJoints(info, *r.clip, path);
  FeatureSequence features = featuresOf(info, *r.clip);
  features.name = path;
  const int seed = seedFramesOf(r, info, features);
  const auto own = trajectoryFromControl(features.control, features.start);
  SampleRequest request{
      .path = {}, .samples = r.samples, .seed = r.seed, .temperature = r.temperature};
  request.startPoses = features.pose.middleRows(seed - info.context, info.context);
  request.startControl = features.control.middleRows(seed - info.context, info.context);
  TaskOutcome out;
  if (r.path.empty()) {
    long end = static_cast<long>(own.size());
    if (r.seconds > 0.0)
      end = std::min(end, seed + std::max(2L, std::lround(r.seconds * info.features.fps)));
    request.path.assign(own.begin() + seed, own.begin() + end);
    out.reference = rebuildMotion(features.pose.middleRows(seed, end - seed),
                                  features.control.middleRows(seed, end - seed), own[seed],
                                  info.skeleton, info.features);
    out.reference->name = r.clip->name;
  } else {
    request.path = placedAt(r.path, own[static_cast<size_t>(seed - 1)]);
  }
  out.motions = sampleClips(model, request, progress);
  return out;
}

}  // namespace

Task predictTask() {
  return {.name = "predict",
          .title = "go on with a motion from its first frames",
          .whyNot = whyNot,
          .run = run};
}

}  // namespace marey

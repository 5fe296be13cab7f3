// Go on with a motion of which the first frames are given.
#include <algorithm>
#include <cmath>

#include "task/task_list.h"

#include "base/error.h"
#include "model/clip_length.h"

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
    throw ShortClipError(
        place,
        fmt::format("fewer than the clip's {} frames at {} per second, with some to come", frames,
                    info.features.fps),
        fmt::format("{}", seed));
  return seed;
}

/// The pose of one frame of a sequence, where it is, as long as `like`.
Clip held(const Clip& like, const FeatureSequence& features, int frame, const MotionModel& model) {
  const Clip whole = sampledClip(model, features);
  const auto pose = whole.frame(frame);
  Clip out = like;
  out.transforms.reset();
  for (int t = 0; t < out.frameCount(); ++t)
    std::copy(pose.begin(), pose.end(), out.frame(t).begin());
  return out;
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
  SampleRequest request{.path = {},
                        .control = r.control,
                        .samples = r.samples,
                        .seed = r.seed,
                        .temperature = r.temperature,
                        .options = r.options};
  request.startPoses = features.pose.middleRows(seed - info.context, info.context);
  request.startControl = features.control.middleRows(seed - info.context, info.context);
  TaskOutcome out;
  if (r.path.empty()) {
    long end = static_cast<long>(own.size());
    if (r.seconds > 0.0)
      end = std::min(end, seed + std::max(2L, std::lround(r.seconds * info.features.fps)));
    request.path.assign(own.begin() + seed, own.begin() + end);
    request.control = requestOf(*r.clip, info.features, features.body);
    request.control.leftOut = r.control.leftOut;
    request.control.annotations =
        startingAt(std::move(request.control.annotations), seed / info.features.fps);
    out.reference = rebuildMotion(features.pose.middleRows(seed, end - seed),
                                  features.control.middleRows(seed, end - seed), own[seed],
                                  features.body ? features.body : info.skeleton, info.features);
    out.reference->name = r.clip->name;
    out.without = held(*out.reference, features, seed - 1, model);
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
          .done = "continued",
          .without = "the last frame held",
          .example = "walk.bvh --seed-frames 20 -n 5 --out predicted",
          .takesPath = true,
          .options = {{.name = "seed_frames",
                       .help = "Frames of the clip that are given, at the model's rate (0: what it "
                               "sees)",
                       .whole = true,
                       .number = [](TaskRequest& r,
                                    double value) { r.seedFrames = static_cast<int>(value); }},
                      {.name = "seconds",
                       .help = "Length (default: the rest of the clip or path)",
                       .number = [](TaskRequest& r, double value) { r.seconds = value; }}},
          .whyNot = whyNot,
          .run = run};
}

}  // namespace marey

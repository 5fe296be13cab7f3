// Fill in joints and frames that are missing from a motion.
#include <algorithm>

#include "task/task_list.h"

#include "base/error.h"
#include "model/pose_units.h"

namespace marey {
namespace {

std::string whyNot(const MotionModel& model) {
  if (!model.info().skeleton) return "one without a skeleton";
  return model.completion() ? "" : "one that cannot fill in what is missing";
}

/// Controls with what the model sees before and after the clip: the first and last row again.
Matrix paddedControls(const ModelInfo& info, const Matrix& control) {
  Matrix out(info.context + control.rows() + info.lookahead, control.cols());
  for (long i = 0; i < out.rows(); ++i)
    out.row(i) = control.row(std::clamp<long>(i - info.context, 0, control.rows() - 1));
  return out;
}

Matrix latentsOf(const ModelInfo& info, const TaskRequest& r, int sample, long frames) {
  const bool perClip = info.latent.per == LatentSpec::Per::Clip;
  Matrix out(perClip ? 1 : frames, info.latent.width);
  for (long t = 0; t < out.rows(); ++t)
    drawLatent(r.seed, sample, static_cast<int>(t), r.temperature, info.latent.degreesOfFreedom,
               {out.row(t).data(), static_cast<size_t>(out.cols())});
  return out;
}

/// Every value of a joint's channels is as known as the joint.
Matrix knownValues(const Matrix& joints, const FeatureSequence& features, const ModelInfo& info) {
  const int jointCount = info.skeleton->jointCount();
  if (joints.rows() != features.frameCount() || joints.cols() != jointCount)
    throwInput({.path = features.name, .item = "mask"},
               fmt::format("{} frames x {} joints", features.frameCount(), jointCount), "{} x {}",
               joints.rows(), joints.cols());
  const auto channels = channelsOf(info);
  Matrix out(joints.rows(), features.pose.cols());
  for (size_t i = 0; i < channels.size(); ++i)
    out.col(static_cast<long>(i)) = joints.col(channels[i].joint);
  return out;
}

TaskOutcome run(const MotionModel& model, const TaskRequest& r, Progress& progress) {
  const ModelInfo& info = model.info();
  if (!r.clip) throw InputError({.path = "complete"}, "a clip to complete", "none");
  const std::string& path = r.clip->source.path.empty() ? r.clip->name : r.clip->source.path;
  requireSameJoints(info, *r.clip, path);
  FeatureSequence features = featuresOf(info, *r.clip);
  features.name = path;
  CompletionRequest request{.poses = features.pose,
                            .known = knownValues(r.knownJoints, features, info),
                            .controls = paddedControls(info, features.control),
                            .latents = {}};
  TaskOutcome out;
  out.reference =
      rebuildMotion(features.pose, features.control, features.start, info.skeleton, info.features);
  for (int sample = 0; sample < r.samples; ++sample) {
    request.latents = latentsOf(info, r, sample, features.pose.rows());
    const FeatureSequence filled{
        .name = fmt::format("sample_{:03}", sample),
        .pose = model.completion()->complete(request, [&] { progress.throwIfCancelled(); }),
        .control = features.control,
        .start = features.start};
    out.motions.push_back(sampledClip(model, filled));
    progress.report((sample + 1.0) / r.samples, "completing");
  }
  return out;
}

}  // namespace

Task completeTask() {
  return {.name = "complete",
          .title = "fill in joints and frames that are missing",
          .whyNot = whyNot,
          .run = run};
}

}  // namespace marey

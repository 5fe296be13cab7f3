// Fill in joints and frames that are missing from a motion.
#include <algorithm>

#include "task/completions.h"
#include "task/task_list.h"

#include "base/error.h"
#include "base/random.h"
#include "model/pose_units.h"

namespace marey {
namespace {

std::string whyNot(const MotionModel& model) {
  if (!model.info().skeleton) return "one without a skeleton";
  return model.completion() ? "" : "one that cannot fill in what is missing";
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

/// The mask that is given, or one that hides joints at random.
Matrix maskOf(const TaskRequest& r, const FeatureSequence& features, const ModelInfo& info) {
  if (r.knownJoints.size() > 0) return r.knownJoints;
  if (!(r.missing > 0.0) || r.missing > 1.0)
    throwInput({.path = features.name, .item = "mask"},
               "a mask, or a share of missing joints above 0 and up to 1", "{}", r.missing);
  Matrix out(features.frameCount(), info.skeleton->jointCount());
  for (long t = 0; t < out.rows(); ++t) {
    const RandomKey key{
        .seed = r.seed, .frame = static_cast<uint32_t>(t), .stage = RandomStage::Observation};
    for (long j = 0; j < out.cols(); ++j)
      out(t, j) = uniformAt(key, static_cast<uint32_t>(j)) < r.missing ? 0.F : 1.F;
  }
  return out;
}

/// What is not known as it was when it last was, or as it will first be.
Matrix lastKnownHeld(const Matrix& poses, const Matrix& known) {
  Matrix out = poses;
  for (long j = 0; j < out.cols(); ++j) {
    long last = -1;
    for (long t = 0; t < out.rows(); ++t) {
      if (known(t, j) != 0.F) {
        for (long k = last < 0 ? 0 : t; k < t; ++k) out(k, j) = out(t, j);
        last = t;
      } else if (last >= 0) {
        out(t, j) = out(last, j);
      }
    }
    if (last < 0) out.col(j).setConstant(poses.col(j).mean());
  }
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
                            .known = knownValues(maskOf(r, features, info), features, info),
                            .controls = {},
                            .latents = {}};
  TaskOutcome out{.motions = completions(model, features, request, r, progress),
                  .reference = sampledClip(model, features),
                  .without = {}};
  features.pose = lastKnownHeld(features.pose, request.known);
  out.without = sampledClip(model, features);
  return out;
}

}  // namespace

Task completeTask() {
  return {
      .name = "complete",
      .title = "fill in joints and frames that are missing",
      .done = "completed",
      .without = "the last known value held",
      .example = "walk.bvh --mask known.csv --out completed",
      .options = {{.name = "mask",
                   .help = "Which joints are known: CSV or NPY, a row for each frame at the "
                           "model's rate, a column for each joint; 1: known, 0: missing",
                   .table = [](TaskRequest& r, Matrix table) { r.knownJoints = std::move(table); }},
                  {.name = "missing",
                   .help = "Without a mask: share of the joints of every frame that is hidden at "
                           "random, from 0 to 1",
                   .number = [](TaskRequest& r, double value) { r.missing = value; }}},
      .whyNot = whyNot,
      .run = run};
}

}  // namespace marey

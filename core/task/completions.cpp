#include "task/completions.h"

#include <algorithm>

namespace marey {
namespace {

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
    drawLatent(info, {r.seed, sample, r.temperature, &r.options}, static_cast<int>(t),
               out.row(t).data());
  return out;
}

}  // namespace

std::vector<Clip> completions(const MotionModel& model, const FeatureSequence& features,
                              CompletionRequest request, const TaskRequest& task,
                              Progress& progress) {
  const ModelInfo& info = model.info();
  request.controls = paddedControls(info, features.control);
  std::vector<Clip> out;
  for (int sample = 0; sample < task.samples; ++sample) {
    request.latents = latentsOf(info, task, sample, features.pose.rows());
    FeatureSequence made = features;
    made.name = fmt::format("sample_{:03}", sample);
    made.pose = model.completion()->complete(request, [&] { progress.throwIfCancelled(); });
    out.push_back(sampledClip(model, made));
    progress.report((sample + 1.0) / task.samples, "completing");
  }
  return out;
}

}  // namespace marey

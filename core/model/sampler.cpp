#include "model/sampler.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace marey {
namespace {

/// Controls around the path: `before` rows that repeat its first motion, the path's own, and
/// `after` rows that repeat its last.
Matrix paddedControl(const Matrix& own, const Matrix& startControl, int before, int after) {
  Matrix out(before + own.rows() + after, own.cols());
  for (int i = 0; i < before; ++i) out.row(i) = own.row(0);
  if (startControl.rows() > 0) {
    const long n = std::min<long>(before, startControl.rows());
    out.middleRows(before - n, n) = startControl.bottomRows(n);
  }
  out.middleRows(before, own.rows()) = own;
  for (int i = 0; i < after; ++i) out.row(before + own.rows() + i) = own.row(own.rows() - 1);
  return out;
}

/// The rows t - context .. t + lookahead in one row, the same for every sample.
Matrix windowFor(const Matrix& control, long first, long rows, int samples) {
  const Eigen::Map<const Eigen::RowVectorXf> flat(control.row(first).data(), rows * control.cols());
  return flat.replicate(samples, 1);
}

void checkFinite(const Matrix& poses, const SampleRequest& request, int frame) {
  if (poses.allFinite()) return;
  for (long b = 0; b < poses.rows(); ++b)
    if (!poses.row(b).allFinite())
      throw NumericError(fmt::format(
          "sample {} left the range of numbers at frame {}: expected finite poses, found NaN or "
          "infinity (try a lower temperature)",
          request.firstSample + b, frame));
}

}  // namespace

void drawLatent(uint64_t seed, int sample, int frame, double temperature, double df,
                std::span<float> out) {
  RandomKey key{
      .seed = seed, .sample = static_cast<uint32_t>(sample), .frame = static_cast<uint32_t>(frame)};
  fillNormal(key, out);
  double scale = temperature;
  if (df > 0.0) {
    key.stage = RandomStage::StudentT;
    scale *= std::sqrt(df / chiSquared(key, df));
  }
  for (float& value : out) value = static_cast<float>(value * scale);
}

void sampleFrames(const MotionModel& model, const SampleRequest& request, const FrameSink& sink,
                  Progress& progress) {
  const ModelInfo& info = model.info();
  if (request.path.empty()) throw InputError({.path = "path"}, "at least one frame", "none");
  if (request.samples < 1) throwInput({.path = "samples"}, "at least one", "{}", request.samples);
  if (info.controlDim != 3)
    throwInput({.path = info.variant}, "a model that is controlled by a path (3 values per frame)",
               "{} control values", info.controlDim);
  const bool warm = request.startPoses.rows() > 0;
  if (warm &&
      (request.startPoses.rows() != info.context || request.startPoses.cols() != info.poseDim))
    throwInput({.path = "start poses"}, fmt::format("{} x {}", info.context, info.poseDim),
               "{} x {}", request.startPoses.rows(), request.startPoses.cols());
  const int warmUp = warm ? 0 : static_cast<int>(std::lround(request.warmUpS * info.features.fps));
  const Matrix control = paddedControl(controlFromTrajectory(request.path), request.startControl,
                                       info.context + warmUp, info.lookahead);
  Matrix history;
  if (warm)
    history =
        Eigen::Map<const Eigen::RowVectorXf>(request.startPoses.data(), request.startPoses.size())
            .replicate(request.samples, 1);
  RolloutState state = model.start(request.samples, history);
  const int frames = warmUp + static_cast<int>(request.path.size());
  Matrix latent(request.samples, info.poseDim);
  for (int t = 0; t < frames; ++t) {
    progress.throwIfCancelled();
    for (int b = 0; b < request.samples; ++b)
      drawLatent(request.seed, request.firstSample + b, t, request.temperature,
                 model.baseDegreesOfFreedom(),
                 {latent.row(b).data(), static_cast<size_t>(info.poseDim)});
    const Matrix poses = model.sampleFrame(
        state, windowFor(control, t, info.context + 1 + info.lookahead, request.samples), latent);
    checkFinite(poses, request, t - warmUp);
    if (t >= warmUp) sink(t - warmUp, poses);
    progress.report((t + 1.0) / frames, "sampling");
  }
}

std::vector<FeatureSequence> sampleSequences(const MotionModel& model, const SampleRequest& request,
                                             Progress& progress) {
  const auto frames = static_cast<long>(request.path.size());
  const Matrix control = controlFromTrajectory(request.path);
  std::vector<FeatureSequence> out;
  for (int b = 0; b < request.samples; ++b)
    out.push_back({fmt::format("sample_{:03}", request.firstSample + b),
                   Matrix(frames, model.info().poseDim), control, request.path.front()});
  sampleFrames(
      model, request,
      [&](int t, const Matrix& batch) {
        for (size_t b = 0; b < out.size(); ++b)
          out[b].pose.row(t) = batch.row(static_cast<long>(b));
      },
      progress);
  return out;
}

Clip sampledClip(const MotionModel& model, const FeatureSequence& sequence) {
  const ModelInfo& info = model.info();
  if (!info.skeleton)
    throw InputError({.path = info.variant}, "a model with a skeleton", "one imported without it");
  Clip clip = rebuildMotion(sequence.pose, sequence.control, sequence.start, info.skeleton,
                            info.features.fps);
  clip.name = sequence.name;
  clip.source.format = "model";
  clip.source.fps = info.features.fps;
  return clip;
}

std::vector<Clip> sampleClips(const MotionModel& model, const SampleRequest& request,
                              Progress& progress) {
  std::vector<Clip> out;
  for (const FeatureSequence& sequence : sampleSequences(model, request, progress))
    out.push_back(sampledClip(model, sequence));
  return out;
}

SampleRequest requestAlongClip(const MotionModel& model, const Clip& clip, bool startFromClip) {
  const ModelInfo& info = model.info();
  const Place place{.path = clip.source.path.empty() ? clip.name : clip.source.path};
  if (3 * clip.jointCount() != info.poseDim)
    throwInput(place, fmt::format("{} joints, as the model has", info.poseDim / 3), "{}",
               clip.jointCount());
  const FeatureSequence features = extractFeatures(clip, info.features);
  const int skipped = startFromClip ? info.context : 0;
  if (features.frameCount() < skipped + 2)
    throwInput(place,
               fmt::format("more than {} frames at {} per second", skipped + 1, info.features.fps),
               "{}", features.frameCount());
  const auto trajectory = trajectoryFromControl(features.control, features.start);
  SampleRequest out;
  out.path.assign(trajectory.begin() + skipped, trajectory.end());
  if (startFromClip) {
    out.startPoses = features.pose.topRows(skipped);
    out.startControl = features.control.topRows(skipped);
  }
  return out;
}

}  // namespace marey

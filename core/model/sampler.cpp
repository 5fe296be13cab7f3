#include "model/sampler.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "model/clip_length.h"
#include "motion/resample.h"

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

/// The rows t - context .. t + lookahead in one row; the last rows again beyond the end.
Eigen::RowVectorXf windowAt(const Matrix& control, long first, long rows) {
  const long from = std::min(first, control.rows() - rows);
  return Eigen::Map<const Eigen::RowVectorXf>(control.row(from).data(), rows * control.cols());
}

void check(const ModelInfo& info, const SampleRequest& r) {
  if (r.path.empty()) throw InputError({.path = "path"}, "at least one frame", "none");
  if (r.samples < 1) throwInput({.path = "samples"}, "at least one", "{}", r.samples);
  if (!info.knowsControl())
    throwInput({.path = info.variant},
               fmt::format("a model of {} control values per frame ({})",
                           info.features.controlWidth(), summaryOf(info.features.control)),
               "{}", info.controlDim);
  requireDrawable(info, r.temperature, r.options, info.variant);
  if (r.startPoses.rows() == 0) return;
  if (r.startPoses.rows() != info.context || r.startPoses.cols() != info.poseDim)
    throwInput({.path = "start poses"}, fmt::format("{} x {}", info.context, info.poseDim),
               "{} x {}", r.startPoses.rows(), r.startPoses.cols());
}

/// One request on its way: its rows of the batch, its control, its warm-up.
struct Lane {
  const SampleRequest* request = nullptr;
  int firstRow = 0;
  int warmUp = 0;
  Matrix control;
  int frames() const { return warmUp + static_cast<int>(request->path.size()); }
};

std::vector<Lane> lanesOf(const ModelInfo& info, std::span<const SampleRequest> requests) {
  std::vector<Lane> out;
  int row = 0;
  for (const SampleRequest& request : requests) {
    check(info, request);
    const bool warm = request.startPoses.rows() > 0;
    Lane lane{&request,
              row,
              warm ? 0 : static_cast<int>(std::lround(request.warmUpS * info.features.fps)),
              {}};
    lane.control = paddedControl(controlOf(info, request), request.startControl,
                                 info.context + lane.warmUp, info.lookahead);
    row += request.samples;
    out.push_back(std::move(lane));
  }
  return out;
}

/// Start poses of the whole batch: a request's own, else the mean pose.
Matrix historyOf(const ModelInfo& info, const std::vector<Lane>& lanes, int rows) {
  if (std::all_of(lanes.begin(), lanes.end(),
                  [](const Lane& l) { return l.request->startPoses.rows() == 0; }))
    return {};
  Eigen::RowVectorXf mean = Eigen::RowVectorXf::Zero(info.poseDim);
  if (!info.standardiser.empty())
    mean = Eigen::Map<const Eigen::RowVectorXf>(info.standardiser.poseMean.data(), info.poseDim);
  Matrix out = mean.replicate(rows, info.context);
  for (const Lane& lane : lanes) {
    const Matrix& poses = lane.request->startPoses;
    if (poses.rows() > 0)
      out.middleRows(lane.firstRow, lane.request->samples) =
          Eigen::Map<const Eigen::RowVectorXf>(poses.data(), poses.size())
              .replicate(lane.request->samples, 1);
  }
  return out;
}

void checkFinite(const ModelInfo& info, const Matrix& poses, const Lane& lane, int frame) {
  for (long b = 0; b < poses.rows(); ++b)
    if (!poses.row(b).allFinite())
      throw NumericError(fmt::format(
          "sample {} left the range of numbers at frame {}: expected finite poses, found NaN or "
          "infinity{}",
          lane.request->firstSample + b, frame,
          info.deterministic() ? "" : " (try a lower temperature)"));
}

/// That of sample `b` of a request in generated frame `t`.
void drawFor(const ModelInfo& info, const SampleRequest& r, int b, int t, float* out) {
  drawLatent(info, {r.seed, r.firstSample + b, r.temperature, &r.options}, t, out);
}

/// All lanes advance together, frame by frame.
void rollOut(const ModelInfo& info, const FrameGenerator& generator, const std::vector<Lane>& lanes,
             const FrameSink& sink, Progress& progress) {
  const int rows = lanes.back().firstRow + lanes.back().request->samples;
  const int window = info.context + 1 + info.lookahead;
  int frames = 0;
  for (const Lane& lane : lanes) frames = std::max(frames, lane.frames());
  RolloutState state = generator.start(rows, historyOf(info, lanes, rows));
  Matrix latent(rows, info.latent.width), control(rows, info.controlWindowWidth());
  for (int t = 0; t < frames; ++t) {
    progress.throwIfCancelled();
    for (const Lane& lane : lanes) {
      const SampleRequest& r = *lane.request;
      control.middleRows(lane.firstRow, r.samples) =
          windowAt(lane.control, t, window).replicate(r.samples, 1);
      for (int b = 0; b < r.samples; ++b)
        drawFor(info, r, b, t, latent.row(lane.firstRow + b).data());
    }
    const Matrix poses = generator.sampleFrame(state, control, latent);
    for (size_t i = 0; i < lanes.size(); ++i) {
      const int frame = t - lanes[i].warmUp;
      // A lane that has ended goes on unheard until the longest one ends.
      if (t >= lanes[i].frames()) continue;
      const Matrix own = poses.middleRows(lanes[i].firstRow, lanes[i].request->samples);
      checkFinite(info, own, lanes[i], frame);
      if (frame >= 0) sink(i, frame, own);
    }
    progress.report((t + 1.0) / frames, "sampling");
  }
}

/// Every motion of a lane, whole.
std::vector<ClipRequest> wholeClipsOf(const ModelInfo& info, const Lane& lane) {
  const bool perClip = info.latent.per == LatentSpec::Per::Clip;
  const long frames = lane.frames(), draws = perClip ? 1 : frames;
  std::vector<ClipRequest> out;
  for (int b = 0; b < lane.request->samples; ++b) {
    ClipRequest clip{lane.request->startPoses, lane.control, Matrix(draws, info.latent.width)};
    for (long t = 0; t < draws; ++t)
      drawFor(info, *lane.request, b, static_cast<int>(t), clip.latents.row(t).data());
    out.push_back(std::move(clip));
  }
  return out;
}

void makeWhole(const ModelInfo& info, const ClipGenerator& generator,
               const std::vector<Lane>& lanes, const FrameSink& sink, Progress& progress) {
  for (size_t i = 0; i < lanes.size(); ++i) {
    const Lane& lane = lanes[i];
    const auto requests = wholeClipsOf(info, lane);
    const auto motions = generator.generate(requests, [&] { progress.throwIfCancelled(); });
    Matrix poses(lane.request->samples, info.poseDim);
    for (int t = 0; t < lane.frames(); ++t) {
      for (size_t b = 0; b < motions.size(); ++b)
        poses.row(static_cast<long>(b)) = motions[b].row(t);
      checkFinite(info, poses, lane, t - lane.warmUp);
      if (t >= lane.warmUp) sink(i, t - lane.warmUp, poses);
    }
    progress.report((static_cast<double>(i) + 1.0) / static_cast<double>(lanes.size()), "sampling");
  }
}

}  // namespace

Matrix controlOf(const ModelInfo& info, const SampleRequest& request) {
  ControlRequest control = request.control;
  if (!control.body) control.body = info.skeleton;
  const FeatureSpec& f = info.features;
  Matrix out = encodeControl(f.control, request.path, control, f.fps, {.path = info.variant});
  fillAbsent(f.control, f.fps, info.standardiser.controlMean, out);
  return out;
}

FeatureSequence sequenceOf(const ModelInfo& info, const SampleRequest& request, int sample,
                           Matrix poses) {
  const bool bodies = channelOf(info.features.control, ControlKind::Skeleton) != nullptr;
  return {.name = fmt::format("sample_{:03}", request.firstSample + sample),
          .pose = std::move(poses),
          .control = controlOf(info, request),
          .start = request.path.front(),
          .body = bodies ? request.control.body : nullptr};
}

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

void drawLatent(const ModelInfo& info, const LatentDraw& draw, int frame, float* out) {
  const bool perClip = info.latent.per == LatentSpec::Per::Clip;
  drawLatent(draw.seed, draw.sample, perClip ? 0 : frame, draw.temperature,
             info.latent.degreesOfFreedom, {out, static_cast<size_t>(info.latent.width)});
  if (draw.options != nullptr) applyOptions(info.optionSchema, *draw.options, out);
}

void requireDrawable(const ModelInfo& info, double temperature, const OptionValues& options,
                     const std::string& origin) {
  // The temperature has a place of its own in documents, where 1 says nothing.
  if (temperature != 1.0) requireOption(info.optionSchema, "temperature", temperature, origin);
  if (options.contains("temperature"))
    throw InputError({.path = origin, .item = "options"}, "the temperature once", "twice");
  requireOptions(info.optionSchema, options, origin);
}

void sampleFrames(const MotionModel& model, std::span<const SampleRequest> requests,
                  const FrameSink& sink, Progress& progress) {
  const ModelInfo& info = model.info();
  const std::vector<Lane> lanes = lanesOf(info, requests);
  if (lanes.empty()) return;
  if (const auto* generator = model.rollout())
    rollOut(info, *generator, lanes, sink, progress);
  else if (const auto* whole = model.wholeClip())
    makeWhole(info, *whole, lanes, sink, progress);
  else
    throw InputError({.path = info.variant}, "a model that makes motion along a path",
                     "one of family " + info.family + ", which does not");
}

std::vector<std::vector<FeatureSequence>> sampleSequences(const MotionModel& model,
                                                          std::span<const SampleRequest> requests,
                                                          Progress& progress) {
  std::vector<std::vector<FeatureSequence>> out;
  for (const SampleRequest& request : requests) {
    check(model.info(), request);
    out.emplace_back();
    for (int b = 0; b < request.samples; ++b)
      out.back().push_back(
          sequenceOf(model.info(), request, b,
                     Matrix(static_cast<long>(request.path.size()), model.info().poseDim)));
  }
  const auto keep = [&](size_t request, int frame, const Matrix& poses) {
    for (size_t b = 0; b < out[request].size(); ++b)
      out[request][b].pose.row(frame) = poses.row(static_cast<long>(b));
  };
  sampleFrames(model, requests, keep, progress);
  return out;
}

std::vector<FeatureSequence> sampleSequences(const MotionModel& model, const SampleRequest& request,
                                             Progress& progress) {
  return sampleSequences(model, std::span(&request, 1), progress).front();
}

Clip sampledClip(const MotionModel& model, const FeatureSequence& sequence) {
  const ModelInfo& info = model.info();
  if (!info.skeleton)
    throw InputError({.path = info.variant}, "a model with a skeleton", "one imported without it");
  Clip clip = rebuildMotion(sequence.pose, sequence.control, sequence.start,
                            sequence.body ? sequence.body : info.skeleton, info.features);
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
  // The control of a frame needs two root frames.
  const auto requireLength = [&](int frames, int given) {
    requireFrames(info, frames, fewestFrames(given + 1), place);
  };
  SampleRequest out;
  if (!startFromClip) {  // the path alone, which any skeleton shows
    validate(clip);
    const auto path = rootPath(resampled(clip, info.features.fps), info.features);
    requireLength(static_cast<int>(path.size()), 0);
    out.path = trajectoryFromControl(controlFromTrajectory(path), path.front());
    out.control = requestOf(clip, info.features, nullptr);
    return out;
  }
  requireSameJoints(info, clip, place.path);
  const FeatureSequence features = featuresOf(info, clip);
  requireLength(features.frameCount(), info.context);
  const auto trajectory = trajectoryFromControl(features.control, features.start);
  out.path.assign(trajectory.begin() + info.context, trajectory.end());
  out.startPoses = features.pose.topRows(info.context);
  out.startControl = features.control.topRows(info.context);
  out.control = requestOf(clip, info.features, features.body);
  out.control.annotations =
      startingAt(std::move(out.control.annotations), info.context / info.features.fps);
  return out;
}

}  // namespace marey

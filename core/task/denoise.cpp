// Take noise out of a motion.
#include <array>

#include "task/completions.h"
#include "task/task_list.h"

#include "base/error.h"
#include "base/random.h"
#include "model/pose_units.h"

namespace marey {
namespace {

/// Of noise that nobody states, metres.
constexpr double kUsualLevelM = 0.01;

std::string whyNot(const MotionModel& model) {
  if (!model.info().skeleton) return "one without a skeleton";
  if (!model.completion() || !model.completion()->denoises())
    return "one that cannot take noise out";
  return {};
}

/// The same values for every number of frames.
Matrix withNoise(const Matrix& poses, const std::vector<double>& deviation, uint64_t seed) {
  Matrix out = poses;
  std::vector<float> noise(static_cast<size_t>(poses.cols()));
  for (long t = 0; t < poses.rows(); ++t) {
    fillNormal({.seed = seed, .frame = static_cast<uint32_t>(t), .stage = RandomStage::Observation},
               noise);
    for (size_t j = 0; j < noise.size(); ++j)
      out(t, static_cast<long>(j)) += static_cast<float>(deviation[j]) * noise[j];
  }
  return out;
}

std::vector<double> times(std::vector<double> scales, double factor) {
  for (double& scale : scales) scale *= factor;
  return scales;
}

TaskOutcome run(const MotionModel& model, const TaskRequest& r, Progress& progress) {
  const ModelInfo& info = model.info();
  if (!r.clip) throw InputError({.path = "denoise"}, "a clip to take noise out of", "none");
  const std::string& path = r.clip->source.path.empty() ? r.clip->name : r.clip->source.path;
  requireSameJoints(info, *r.clip, path);
  FeatureSequence features = featuresOf(info, *r.clip);
  features.name = path;
  const auto scales = floorScales(channelsOf(info));
  TaskOutcome out;
  if (r.noiseM > 0.0) {
    out.reference = sampledClip(model, features);
    features.pose = withNoise(features.pose, times(scales, r.noiseM), r.seed);
    out.without = sampledClip(model, features);
  }
  const double level = r.levelM > 0.0 ? r.levelM : r.noiseM > 0.0 ? r.noiseM : kUsualLevelM;
  CompletionRequest request{.poses = features.pose,
                            .known = Matrix::Ones(features.pose.rows(), features.pose.cols()),
                            .controls = {},
                            .latents = {},
                            .noise = times(scales, level)};
  out.motions = completions(model, features, request, r, progress);
  return out;
}

}  // namespace

Task denoiseTask() {
  return {
      .name = "denoise",
      .title = "take noise out of a motion",
      .done = "cleaned",
      .without = "the noise left in",
      .example = "captured.bvh --level 0.02 --out clean",
      .options = {{.name = "noise",
                   .help = "Deviation of noise that is added first, metres (angles as that of a "
                           "point 0.25 m away): the error against the clip is then known",
                   .number = [](TaskRequest& r, double value) { r.noiseM = value; }},
                  {.name = "level",
                   .help = "Deviation of the noise that is taken out, metres (default: what is "
                           "added, else 0.01)",
                   .number = [](TaskRequest& r, double value) { r.levelM = value; }}},
      .whyNot = whyNot,
      .run = run};
}

}  // namespace marey

#include "experiment/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "model/sampler.h"
#include "stats/footsteps.h"

namespace marey {
namespace {

/// Samples of different stages of one experiment take different latents.
constexpr int kHeldOutSampleBase = 1000000;
/// Natural clips whose control is followed in one batch.
constexpr size_t kClipsTogether = 64;

double seconds(std::chrono::steady_clock::time_point from) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

void checkRate(const MotionModel& model, const Experiment& experiment) {
  if (std::abs(model.info().features.fps - experiment.fps) > 1e-6)
    throwInput(
        {.path = experiment.title, .item = "key 'fps'"},
        fmt::format("the rate of model {}: {}", model.info().variant, model.info().features.fps),
        "{}", experiment.fps);
}

/// Along each natural clip's own control. Clips of similar length go together.
void sampleHeldOut(const MotionModel& model, const Experiment& e, const std::vector<Clip>& natural,
                   SystemResult& out, Progress& progress) {
  std::vector<SampleRequest> requests;
  for (size_t i = 0; i < natural.size(); ++i) {
    requests.push_back(requestAlongClip(model, natural[i], false));
    requests.back().samples = e.heldOutSamples;
    requests.back().seed = e.seed;
    requests.back().temperature = out.temperature;
    requests.back().firstSample = kHeldOutSampleBase + static_cast<int>(i) * e.heldOutSamples;
  }
  std::vector<size_t> order(natural.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return requests[a].path.size() < requests[b].path.size();
  });
  std::vector<std::vector<FeatureSequence>> sampled(natural.size());
  double frames = 0.0;
  const auto begin = std::chrono::steady_clock::now();
  for (size_t first = 0; first < order.size(); first += kClipsTogether) {
    const size_t last = std::min(first + kClipsTogether, order.size());
    std::vector<SampleRequest> batch;
    for (size_t i = first; i < last; ++i) batch.push_back(requests[order[i]]);
    Progress part = progress.part(static_cast<double>(first) / static_cast<double>(order.size()),
                                  static_cast<double>(last) / static_cast<double>(order.size()));
    auto results = sampleSequences(model, batch, part);
    for (size_t i = first; i < last; ++i) {
      frames += static_cast<double>(e.heldOutSamples) *
                static_cast<double>(requests[order[i]].path.size());
      sampled[order[i]] = std::move(results[i - first]);
    }
  }
  out.framesPerSecond = frames / seconds(begin);
  std::vector<FeatureSequence> scored;
  for (size_t i = 0; i < natural.size(); ++i)
    for (const FeatureSequence& sequence : sampled[i]) {
      if (sequence.frameCount() > model.info().context) scored.push_back(sequence);
      out.heldOut.push_back(sampledClip(model, sequence));
      out.heldOut.back().name = natural[i].name + "/" + sequence.name;
      out.heldOutPaths.push_back(requests[i].path);
    }
  Progress scoring = progress.part(1.0, 1.0);
  out.heldOutScores = scoreSequences(model, scored, false, scoring);
}

void samplePaths(const MotionModel& model, const Experiment& e, SystemResult& out,
                 Progress& progress) {
  for (size_t i = 0; i < e.paths.size(); ++i) {
    const ExperimentPath& path = e.paths[i];
    Progress part = progress.part(static_cast<double>(i) / static_cast<double>(e.paths.size()),
                                  static_cast<double>(i + 1) / static_cast<double>(e.paths.size()));
    SampleRecipe recipe{.system = {out.name, {}, out.temperature},
                        .path = path,
                        .samples = e.samples,
                        .seed = e.seed,
                        .fps = e.fps,
                        .folder = e.folder};
    SampleSet set = drawSampleSet(model, recipe, part);
    PathSamples& samples = out.paths[path.name];
    samples.wanted = std::move(set.wanted);
    for (SampledMotion& motion : set.motions) {
      samples.scores.push_back(std::move(motion.score));
      samples.clips.push_back(std::move(motion.clip));
    }
  }
}

void scoreNatural(const MotionModel& model, const std::vector<Clip>& natural, SystemResult& out,
                  Progress& progress) {
  std::vector<Clip> clips;
  for (const Clip& clip : natural)
    // A clip that is all context has no frame to score.
    if (clip.frameCount() > model.info().context) clips.push_back(clip);
  out.naturalScores = scoreClips(model, clips, false, progress);
  double sum = 0.0, frames = 0.0;
  for (const ClipScore& score : out.naturalScores) {
    for (const double nats : score.loglikNats) sum += nats;
    frames += static_cast<double>(score.loglikNats.size());
  }
  out.naturalNatsPerFrame = frames > 0 ? sum / frames : std::numeric_limits<double>::quiet_NaN();
}

double floorOf(const ModelInfo& info) {
  const Json facts = info.provenance.value("facts", Json::object());
  if (!facts.contains("linear_gaussian_nats_per_frame"))
    return std::numeric_limits<double>::quiet_NaN();
  return facts["linear_gaussian_nats_per_frame"].get<double>() + info.standardiser.logDetPerFrame();
}

}  // namespace

ExperimentResult runExperiment(const Experiment& experiment, std::span<const ModelFamily> families,
                               Progress& progress) {
  if (experiment.natural.empty())
    throw InputError({.path = experiment.title, .item = "key 'natural'"},
                     "at least one source of clips", "none");
  ExperimentResult out{.experiment = experiment, .hash = experimentHash(experiment)};
  Progress reading = progress.part(0.0, 0.05);
  out.natural = naturalClips(experiment, reading);
  out.feet = stats::feetOf(*out.natural.front().skeleton, experiment.feet);
  const double share = 0.95 / static_cast<double>(std::max<size_t>(1, experiment.systems.size()));
  for (size_t i = 0; i < experiment.systems.size(); ++i) {
    const ExperimentSystem& system = experiment.systems[i];
    const auto model = loadModel((experiment.folder / system.model).string(), families);
    checkRate(*model, experiment);
    SystemResult result{
        .name = system.name, .info = model->info(), .temperature = system.temperature};
    const double from = 0.05 + share * static_cast<double>(i);
    Progress scoring = progress.part(from, from), heldOut = progress.part(from, from + 0.5 * share),
             paths = progress.part(from + 0.5 * share, from + share);
    scoreNatural(*model, out.natural, result, scoring);
    if (experiment.heldOutSamples > 0)
      sampleHeldOut(*model, experiment, out.natural, result, heldOut);
    samplePaths(*model, experiment, result, paths);
    result.linearGaussianNats = floorOf(result.info);
    out.systems.push_back(std::move(result));
  }
  return out;
}

}  // namespace marey

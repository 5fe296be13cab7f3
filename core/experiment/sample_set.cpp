#include "experiment/sample_set.h"

#include <algorithm>
#include <chrono>

#include "model/sampler.h"

namespace marey {
namespace {
/// Larger batches gain little and make cancelling slow.
constexpr int kMostTogether = 64;

SampleSet drawSteered(const MotionModel& model, const SampleRecipe& recipe, Progress& progress,
                      const MotionSink& sink) {
  SampleSet out{.recipe = recipe, .modelHash = model.info().hash};
  // The model outlives the rollouts, which end here.
  const std::shared_ptr<const MotionModel> borrowed(std::shared_ptr<const MotionModel>(), &model);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < recipe.samples; ++i) {
    progress.throwIfCancelled();
    Steering steering = *recipe.steering;
    steering.options.seed = recipe.seed;
    steering.options.temperature = recipe.system.temperature;
    steering.options.options = recipe.system.options;
    steering.options.sample += i;
    const LiveRollout rollout = replay(borrowed, steering);
    const FeatureSequence sequence = rollout.sequence();
    Progress scoring = progress.part(0.0, 0.0);
    std::vector<SampledMotion> motions{
        {std::make_shared<const Clip>(sampledClip(model, sequence)),
         scoreSequences(model, {&sequence, 1}, false, scoring).front()}};
    out.wanted = rollout.trajectory();
    out.motions.push_back(motions.front());
    if (sink) sink(out.wanted, std::move(motions));
    progress.report((i + 1.0) / recipe.samples);
  }
  const double spentS =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.framesPerSecond =
      static_cast<double>(recipe.samples) * static_cast<double>(out.wanted.size()) / spentS;
  return out;
}

}  // namespace

Json toJson(const SampleRecipe& recipe) {
  Json out = {{"system", toJson(recipe.system)},
              {"path", toJson(recipe.path)},
              {"samples", recipe.samples},
              {"seed", recipe.seed},
              {"start", recipe.path.startFromClip ? "clip" : "mean"}};
  if (recipe.steering) out["steering"] = toJson(*recipe.steering);
  if (recipe.heldOut) out["held_out"] = true;
  return out;
}

KeptSet keptSetOf(const SampleRecipe& recipe) {
  KeptSet out{.system = recipe.system,
              .path = recipe.path,
              .samples = recipe.samples,
              .seed = recipe.seed,
              .heldOut = recipe.heldOut,
              .hidden = {}};
  if (recipe.steering) out.steering = *recipe.steering;
  return out;
}

SampleRecipe recipeOf(const KeptSet& set, double fps, const std::filesystem::path& folder) {
  return {.system = set.system,
          .path = set.path,
          .samples = set.samples,
          .seed = set.seed,
          .fps = fps,
          .folder = folder,
          .steering = set.steering ? std::make_shared<const Steering>(*set.steering) : nullptr,
          .heldOut = set.heldOut};
}

SampleRequest requestOf(const MotionModel& model, const SampleRecipe& recipe) {
  SampleRequest request =
      requestFor(model, {.path = recipe.path.path.empty() ? recipe.path.name : recipe.path.path,
                         .wayPoints = recipe.path.wayPoints,
                         .seconds = recipe.path.seconds,
                         .startFromClip = recipe.path.startFromClip,
                         .control = recipe.path.control,
                         .folder = recipe.folder});
  request.samples = recipe.samples;
  request.seed = recipe.seed;
  request.temperature = recipe.system.temperature;
  request.options = recipe.system.options;
  return request;
}

SampleSet drawSampleSet(const MotionModel& model, const SampleRecipe& recipe, Progress& progress,
                        int chunk, const MotionSink& sink) {
  if (recipe.steering) return drawSteered(model, recipe, progress, sink);
  if (recipe.heldOut)
    throw InputError({.path = recipe.system.name}, "a path", "the control of natural clips");
  SampleRequest request = requestOf(model, recipe);
  SampleSet out{.recipe = recipe, .modelHash = model.info().hash, .wanted = request.path};
  int together = chunk > 0 ? chunk : recipe.samples;
  double spentS = 0.0;
  for (int first = 0; first < recipe.samples; first += request.samples) {
    request.firstSample = first;
    request.samples = std::min(together, recipe.samples - first);
    const double all = recipe.samples;
    Progress part = progress.part(first / all, (first + request.samples) / all);
    const auto begin = std::chrono::steady_clock::now();
    const auto sequences = sampleSequences(model, request, part);
    spentS += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::vector<SampledMotion> motions;
    Progress scoring = part.part(1.0, 1.0);
    const auto scores = scoreSequences(model, sequences, false, scoring);
    for (size_t i = 0; i < sequences.size(); ++i) {
      progress.throwIfCancelled();
      motions.push_back(
          {std::make_shared<const Clip>(sampledClip(model, sequences[i])), scores[i]});
    }
    out.motions.insert(out.motions.end(), motions.begin(), motions.end());
    if (sink) sink(out.wanted, std::move(motions));
    together = std::max(together, std::min(2 * together, kMostTogether));
  }
  const double frames =
      static_cast<double>(recipe.samples) * static_cast<double>(out.wanted.size());
  out.framesPerSecond = spentS > 0.0 ? frames / spentS : 0.0;
  return out;
}

}  // namespace marey

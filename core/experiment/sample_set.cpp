#include "experiment/sample_set.h"

#include <algorithm>
#include <chrono>

#include "model/sampler.h"

namespace marey {

Json toJson(const SampleRecipe& recipe) {
  Experiment one;
  one.systems = {recipe.system};
  one.paths = {recipe.path};
  const Json document = toJson(one);
  return {{"system", document["systems"][0]},
          {"path", document["paths"][0]},
          {"samples", recipe.samples},
          {"seed", recipe.seed},
          {"start", recipe.startFromClip ? "clip" : "mean"}};
}

SampleSet drawSampleSet(const MotionModel& model, const SampleRecipe& recipe, Progress& progress,
                        int chunk, const MotionSink& sink) {
  SampleRequest request =
      requestFor(model, {.path = recipe.path.path.empty() ? recipe.path.name : recipe.path.path,
                         .wayPoints = recipe.path.wayPoints,
                         .seconds = recipe.path.seconds,
                         .startFromClip = recipe.startFromClip,
                         .folder = recipe.folder});
  request.seed = recipe.seed;
  request.temperature = recipe.system.temperature;
  SampleSet out{.recipe = recipe, .modelHash = model.info().hash, .wanted = request.path};
  const int together = chunk > 0 ? chunk : recipe.samples;
  double spentS = 0.0;
  for (int first = 0; first < recipe.samples; first += together) {
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
  }
  const double frames =
      static_cast<double>(recipe.samples) * static_cast<double>(out.wanted.size());
  out.framesPerSecond = spentS > 0.0 ? frames / spentS : 0.0;
  return out;
}

}  // namespace marey

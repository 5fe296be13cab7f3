#include "experiment/held_out_set.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/ranks.h"
#include "experiment/run.h"

namespace marey {

SampleRecipe heldOutRecipe(const Experiment& experiment, const ExperimentSystem& system) {
  return {.system = system,
          .path = {.name = "held-out control", .path = "natural", .seconds = 0.0},
          .samples = std::max(1, experiment.heldOutSamples),
          .seed = experiment.seed,
          .fps = experiment.fps,
          .folder = experiment.folder,
          .heldOut = true};
}

std::vector<Motion> heldOutSet(const MotionModel& model, const SampleRecipe& recipe,
                               const std::vector<Clip>& natural, const std::vector<int>& followed,
                               Progress& progress) {
  if (natural.empty())
    throw InputError({.path = recipe.system.name}, "natural clips whose control is followed",
                     "none");
  Experiment e;
  e.heldOutSamples = recipe.samples;
  e.seed = recipe.seed;
  e.fps = recipe.fps;
  SystemResult result{.name = recipe.system.name,
                      .info = model.info(),
                      .temperature = recipe.system.temperature,
                      .options = recipe.system.options};
  Ranks alone;
  sampleHeldOut(model, e, natural, result, progress, alone);
  std::vector<Motion> out;
  for (size_t i = 0; i < result.heldOut.size(); ++i)
    out.push_back({.clip = std::make_shared<const Clip>(std::move(result.heldOut[i])),
                   .score = std::move(result.heldOutScores[i]),
                   .visible = false,
                   .source = {},
                   .wanted = std::make_shared<const std::vector<RootFrame>>(
                       std::move(result.heldOutPaths[i])),
                   .follows = followed[i / static_cast<size_t>(recipe.samples)]});
  return out;
}

}  // namespace marey

#include "gui/plots/plot_recipe.h"

#include "gui/plots/motion_sets.h"
#include <fmt/format.h>

#include "experiment/recipe.h"

namespace marey::gui {

render::Recipe plotRecipe(const std::string& plot, const Experiment& experiment,
                          const std::vector<MotionGroup>& groups,
                          const std::optional<TimeRange>& range, Comparison comparison) {
  std::vector<RecipeSet> sets;
  for (const MotionSet& set : motionSets(groups, comparison)) {
    RecipeSet entry{set.name, {}, std::to_string(set.clips.size())};
    for (const MotionGroup& group : groups)
      if (group.id == set.group && group.recipe)
        entry.origin = SampleOrigin{group.modelHash, group.recipe->seed,
                                    group.recipe->system.temperature, group.recipe->system.options};
    sets.push_back(std::move(entry));
  }
  render::Recipe out = recipeOf(experimentHash(experiment), sets);
  out.emplace_back("plot", plot);
  out.emplace_back("natural", fmt::format("{}", fmt::join(experiment.natural, ", ")));
  if (range) out.emplace_back("range_s", fmt::format("{:g} to {:g}", range->beginS, range->endS));
  return out;
}

}  // namespace marey::gui

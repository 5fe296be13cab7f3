#include "plots/plot_recipe.h"

#include "plots/motion_sets.h"
#include <fmt/format.h>

namespace marey::gui {

render::Recipe plotRecipe(const std::string& plot, const Experiment& experiment,
                          const std::vector<MotionGroup>& groups,
                          const std::optional<TimeRange>& range) {
  render::Recipe out{
      {"marey", MAREY_VERSION}, {"plot", plot}, {"experiment", experimentHash(experiment)}};
  if (range)
    out.emplace_back("range_s", fmt::format("{:.4g} to {:.4g}", range->beginS, range->endS));
  for (const MotionSet& set : motionSets(groups)) {
    out.emplace_back("motions " + set.name, std::to_string(set.clips.size()));
    for (const MotionGroup& group : groups) {
      if (group.id != set.group || !group.recipe) continue;
      out.emplace_back("model " + set.name, group.modelHash);
      out.emplace_back("seed " + set.name, std::to_string(group.recipe->seed));
      out.emplace_back("temperature " + set.name,
                       fmt::format("{}", group.recipe->system.temperature));
    }
  }
  return out;
}

}  // namespace marey::gui

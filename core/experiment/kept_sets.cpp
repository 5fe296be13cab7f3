#include "experiment/kept_sets.h"

#include <fmt/format.h>

#include "base/error.h"
#include "experiment/edits.h"

namespace marey {

bool canBeKept(const KeptSet& set) {
  try {
    viewStateFromJson({{"sets", Json::array({toJson(set)})}}, "view", {});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

KeptSet inFolder(KeptSet set, const std::filesystem::path& from, const std::filesystem::path& to) {
  if (from == to) return set;
  Experiment carrier;
  carrier.folder = from;
  carrier.view.sets = {std::move(set)};
  moveToFolder(carrier, to);
  return carrier.view.sets.front();
}

SampleRecipe inFolder(const SampleRecipe& recipe, const std::filesystem::path& folder) {
  return recipeOf(inFolder(keptSetOf(recipe), recipe.folder, folder), recipe.fps, folder);
}

std::string keyOf(const KeptSet& set) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", set.system.name, set.system.temperature,
                     textOf(set.system.options), set.path.name, set.samples, set.seed,
                     fmt::join(set.leftOut, " "));
}

}  // namespace marey

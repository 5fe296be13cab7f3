#include "experiment/recipe.h"

#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

namespace marey {

Json motionRecipe(const std::string& experimentHash, const std::optional<SampleOrigin>& origin) {
  Json out = {{"marey", MAREY_VERSION}};
  if (!experimentHash.empty()) out["experiment_hash"] = experimentHash;
  if (!origin) return out;
  out["model_hash"] = origin->modelHash;
  out["seed"] = origin->seed;
  out["temperature"] = origin->temperature;
  if (!origin->options.empty()) out["options"] = origin->options;
  return out;
}

RecipeText recipeOf(const std::string& experimentHash, const std::vector<RecipeSet>& sets) {
  static constexpr const char* kKeys[] = {"model_hash", "seed", "temperature"};
  RecipeText out = {{"marey", MAREY_VERSION}, {"experiment_hash", experimentHash}}, named;
  std::map<std::string, std::set<std::string>> values;
  for (const RecipeSet& set : sets) {
    if (set.origin) {
      const std::string texts[] = {set.origin->modelHash, std::to_string(set.origin->seed),
                                   fmt::format("{}", set.origin->temperature)};
      for (size_t k = 0; k < std::size(kKeys); ++k) {
        named.emplace_back(std::string(kKeys[k]) + " " + set.name, texts[k]);
        values[kKeys[k]].insert(texts[k]);
      }
      if (!set.origin->options.empty())
        named.emplace_back("options " + set.name, textOf(set.origin->options));
    }
    named.emplace_back("motions " + set.name, set.motions);
  }
  for (const char* key : kKeys)
    if (values[key].size() == 1) out.emplace_back(key, *values[key].begin());
  out.insert(out.end(), named.begin(), named.end());
  return out;
}

}  // namespace marey

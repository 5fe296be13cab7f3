// What every file that comes of an experiment carries, under the same keys wherever it is made:
// "marey" (version), "experiment_hash", and of samples "model_hash", "seed" and "temperature",
// and "options" where any were given.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "model/sampling_option.h"

namespace marey {

/// How samples came about; nothing of it is asked again when a file is written later.
struct SampleOrigin {
  std::string modelHash;
  uint64_t seed = 0;
  double temperature = 1.0;
  OptionValues options = {};
};

/// Motions of one name in a file: natural ones, or those of a system.
struct RecipeSet {
  std::string name;
  std::optional<SampleOrigin> origin;  ///< none: natural motion
  /// How many motions, or which.
  std::string motions;
};

/// (key, value) in the order of writing, as render::Recipe.
using RecipeText = std::vector<std::pair<std::string, std::string>>;

/// The keys of one motion; without an experiment (an empty hash) that key is left out.
Json motionRecipe(const std::string& experimentHash, const std::optional<SampleOrigin>& origin);
/// The keys of several: those of samples are followed by the name of their set, "seed MG". A value
/// that all samples share stands under the bare key as well, so that scripts find it there.
RecipeText recipeOf(const std::string& experimentHash, const std::vector<RecipeSet>& sets);

}  // namespace marey

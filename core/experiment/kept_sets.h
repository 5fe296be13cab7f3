// Sample sets as documents keep them: named from their folder, and told apart.
#pragma once

#include <string>

#include "experiment/sample_set.h"

namespace marey {

/// Whether a document that names the set can be opened (a steered motion of one frame has no path,
/// for example).
bool canBeKept(const KeptSet& set);
/// The same set with files named from another folder than `from`.
KeptSet inFolder(KeptSet set, const std::filesystem::path& from, const std::filesystem::path& to);
/// The same recipe with files named from `folder`.
SampleRecipe inFolder(const SampleRecipe& recipe, const std::filesystem::path& folder);
/// What tells kept sets apart: how they were made, and what of them is left out.
std::string keyOf(const KeptSet& set);

}  // namespace marey

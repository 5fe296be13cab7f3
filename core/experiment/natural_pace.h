// How fast and how sharply turning natural motion is, by which paths are judged.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/path_curve.h"

namespace marey {

/// A model by its name among people.
struct PaceModel {
  std::string name, file;
};

/// Of the training data of the first model that knows them, else of natural clips; none without
/// either. What is wrong with a model's file is not told here: sampling does. Throws
/// CancelledError.
std::optional<PaceRange> naturalPace(const std::vector<PaceModel>& models,
                                     const std::vector<std::shared_ptr<const Clip>>& clips,
                                     Progress& progress);

}  // namespace marey

// What every file of a plot carries.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/motions.h"
#include "render/base/recipe.h"

namespace marey::gui {

/// Document, range, and of every visible set its motions, model, seed and temperature.
render::Recipe plotRecipe(const std::string& plot, const Experiment& experiment,
                          const std::vector<MotionGroup>& groups,
                          const std::optional<TimeRange>& range,
                          Comparison comparison = Comparison::ThisPath);

}  // namespace marey::gui

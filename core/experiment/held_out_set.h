// Motions along the control of natural clips, as a sample set.
#pragma once

#include <vector>

#include "experiment/motions.h"

namespace marey {

/// The recipe of a system along the control of every natural clip, with the document's settings.
SampleRecipe heldOutRecipe(const Experiment& experiment, const ExperimentSystem& system);

/// As a report draws them, hidden at first: recipe.samples motions along each of `natural`, clip by
/// clip. `followed` are their numbers among all natural motions. Throws InputError without clips,
/// and as sampleHeldOut of experiment/run.h does.
std::vector<Motion> heldOutSet(const MotionModel& model, const SampleRecipe& recipe,
                               const std::vector<Clip>& natural, const std::vector<int>& followed,
                               Progress& progress);

}  // namespace marey

// What completing and denoising have in common. Internal to this folder.
#pragma once

#include "task/task.h"

namespace marey {

/// Samples of what a model makes of a sequence with values that are unknown or noisy. Controls and
/// latents of `request` are filled in.
std::vector<Clip> completions(const MotionModel& model, const FeatureSequence& features,
                              CompletionRequest request, const TaskRequest& task,
                              Progress& progress);

}  // namespace marey

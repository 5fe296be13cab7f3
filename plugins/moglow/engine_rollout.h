// What a RolloutState of the engine holds, and what turns values into the model's. Internal to the
// sources of EngineModel.
#pragma once

#include "moglow/engine_model.h"

namespace marey::moglow {

/// A value: a copy is a fork.
struct EngineModel::Rollout {
  nn::AlignedFloats history;           ///< [B, tau * D], standardised, oldest frame first
  nn::AlignedFloats control;           ///< [B, controlWidth], standardised, of the frame being made
  nn::AlignedFloats features;          ///< [B, featureWidth]; with a base
  nn::AlignedFloats pose;              ///< [B, D], standardised; with a base
  std::vector<RowForesight> foreseen;  ///< memory of the frame being made; with a base
  FlowEngine::State flow;
};

/// (value - mean) / std of each of `width` dimensions, again and again.
inline void standardise(const float* values, long count, const std::vector<float>& mean,
                        const std::vector<float>& std, float* out) {
  const auto width = static_cast<long>(mean.size());
  for (long i = 0; i < count; i += width)
    for (long j = 0; j < width; ++j)
      out[i + j] = (values[i + j] - mean[static_cast<size_t>(j)]) / std[static_cast<size_t>(j)];
}

}  // namespace marey::moglow

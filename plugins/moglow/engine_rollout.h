// What a RolloutState of the engine holds. Internal to the sources of EngineModel.
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
  nn::FlowEngine::State flow;
};

}  // namespace marey::moglow

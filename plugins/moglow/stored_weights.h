// Strict checks of stored MoGlow models without building the network. Internal (libtorch types).
#pragma once

#include <memory>
#include <string>

#include "base/tensor_file.h"
#include "moglow/config.h"
#include "moglow/engine_base.h"
#include "moglow/pose_base.h"

namespace marey::moglow {

/// Throws InputError naming `origin` when a tensor of the flow is missing, mis-shaped or not
/// finite, or when there is one that the model does not have.
void checkFlow(const Config& config, const TensorFile& file, const std::string& origin);

/// The engine's base with the tensors that are stored as `name` ("base", "motion"); null for
/// configurations without one. As strict.
std::unique_ptr<const EngineBase> loadBase(const Config& config, const BodyFacts& body,
                                           const TensorFile& file, const std::string& name,
                                           const std::string& origin);

}  // namespace marey::moglow

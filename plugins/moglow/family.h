// MoGlow as a family of motion models (Alexanderson et al. 2019; Henter et al. 2020).
#pragma once

#include <memory>
#include <string>

#include "model/motion_model.h"

namespace marey {
class TrainableModel;
}

namespace marey::moglow {

ModelFamily family();

/// A model from the authors' PyTorch checkpoint. `config` as in configFromJson; missing
/// dimensions come from the tensors. Without a standardiser the model is marked as such.
/// Throws InputError for missing, extra, mis-shaped or non-finite tensors.
std::unique_ptr<MotionModel> importCheckpoint(const std::string& checkpoint, const Json& config,
                                              const std::string& configOrigin,
                                              const Standardiser& standardiser,
                                              const std::string& variant);

}  // namespace marey::moglow

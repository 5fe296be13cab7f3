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
/// `stateDict` names one of several in the file (see chooseStateDict); which was taken and what was
/// left out stands in the provenance ("state_dict", "left_out").
/// Throws InputError for missing, extra, mis-shaped or non-finite tensors.
std::unique_ptr<MotionModel> importCheckpoint(const std::string& checkpoint, const Json& config,
                                              const std::string& configOrigin,
                                              const Standardiser& standardiser,
                                              const std::string& variant,
                                              const std::string& stateDict = "");

}  // namespace marey::moglow

// MoGlow as a family of motion models (Alexanderson et al. 2019; Henter et al. 2020).
#pragma once

#include <memory>
#include <string>

#include "model/model_family.h"

namespace marey::moglow {

ModelFamily family();

/// A model from the authors' PyTorch checkpoint. The configuration as in configFromJson; missing
/// dimensions come from the tensors. Which state dict was taken and what was left out stands in
/// the provenance ("state_dict", "left_out").
/// Throws InputError for missing, extra, mis-shaped or non-finite tensors.
std::unique_ptr<MotionModel> importCheckpoint(const ImportRequest& request);

}  // namespace marey::moglow

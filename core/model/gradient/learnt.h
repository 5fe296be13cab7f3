// Which part of a stored model was learnt. No libtorch type appears here.
#pragma once

#include <set>
#include <string>

#include "model/model_family.h"

namespace marey {

/// Names of the stored tensors that training by gradient changes: they bear to be kept in 16 bits,
/// which what was fitted in closed form and standardisers do not.
std::set<std::string> learntTensors(const TrainableModel& net);
/// Those of a model of the family; none where it is built at once.
std::set<std::string> learntTensors(const ModelFamily& family, const ModelInfo& info);

}  // namespace marey

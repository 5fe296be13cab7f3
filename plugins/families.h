// The model families that this build knows: one explicit list.
#pragma once

#include <span>

#include "model/model_family.h"

namespace marey {

std::span<const ModelFamily> modelFamilies();

}  // namespace marey

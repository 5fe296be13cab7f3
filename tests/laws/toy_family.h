// A family that is as little like a flow as can be: two latent values, no density, no gradient, no
// libtorch. If the core knows more of a model than the contract says, this one shows it.
#pragma once

#include "model/model_family.h"

namespace marey::test {

/// Poses are the mean of the data plus what the control explains linearly plus `directions`
/// principal directions of the rest, each moved by one latent value.
ModelFamily toyFamily();

}  // namespace marey::test

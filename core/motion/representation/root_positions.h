// Joint positions in the root frame, y = true height: joints x 3 values, metres (Habibie et al. 2017;
// Henter et al. 2020).
#pragma once

#include "motion/representation/representation.h"

namespace marey {

Representation rootPositions();

}  // namespace marey

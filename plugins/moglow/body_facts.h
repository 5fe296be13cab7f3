// What a base must know of the data besides its widths.
#pragma once

#include <vector>

#include "model/motion_model.h"

namespace marey::moglow {

struct BodyFacts {
  std::vector<int> parents;  ///< of the joints; empty where unknown
  std::vector<int> feet;     ///< contact joints, left ones first
  std::vector<int> toes;     ///< beside each foot: its child, else its parent
  std::vector<float> poseMean, poseStd, controlMean, controlStd;
};

/// `skeleton`: null where a model has none.
BodyFacts bodyFacts(const Skeleton* skeleton, const Standardiser& standardiser);

}  // namespace marey::moglow

#include "moglow/body_facts.h"

#include <algorithm>

#include "motion/roles.h"

namespace marey::moglow {

BodyFacts bodyFacts(const Skeleton* skeleton, const Standardiser& s) {
  BodyFacts out{.poseMean = s.poseMean,
                .poseStd = s.poseStd,
                .controlMean = s.controlMean,
                .controlStd = s.controlStd};
  if (skeleton == nullptr) return out;
  out.parents = skeleton->parents;
  out.feet = rolesOf(*skeleton).feet;
  for (const int foot : out.feet) {
    const auto child = std::find(out.parents.begin(), out.parents.end(), foot);
    out.toes.push_back(child == out.parents.end() ? out.parents[static_cast<size_t>(foot)]
                                                  : static_cast<int>(child - out.parents.begin()));
  }
  return out;
}

}  // namespace marey::moglow

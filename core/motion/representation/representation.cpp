#include "motion/representation/representation.h"

#include <algorithm>

#include "motion/representation/joint_expmap.h"
#include "motion/representation/root_positions.h"

namespace marey {

std::span<const Representation> representations() {
  static const std::vector<Representation> all{rootPositions(), jointExpmap()};
  return all;
}

const Representation& representationNamed(const std::string& name, const Place& place) {
  std::string known;
  for (const Representation& r : representations()) {
    const auto& former = r.formerNames;
    if (r.name == name || std::find(former.begin(), former.end(), name) != former.end()) return r;
    known += (known.empty() ? "" : ", ") + r.name;
  }
  throw InputError(place, "one of " + known, "'" + name + "'");
}

const Representation& representationOf(const FeatureSpec& spec, const std::string& origin) {
  return representationNamed(spec.layout, {.path = origin, .item = "feature layout"});
}

}  // namespace marey

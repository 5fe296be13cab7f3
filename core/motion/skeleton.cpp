#include "motion/skeleton.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace marey {

int Skeleton::find(const std::string& name) const {
  const auto it = std::find(names.begin(), names.end(), name);
  return it == names.end() ? -1 : static_cast<int>(it - names.begin());
}

std::vector<std::pair<int, int>> Skeleton::bones() const {
  std::vector<std::pair<int, int>> out;
  for (int j = 0; j < jointCount(); ++j)
    if (parents[j] >= 0) out.emplace_back(parents[j], j);
  return out;
}

bool Skeleton::operator==(const Skeleton& other) const {
  const auto sameSite = [](const EndSite& a, const EndSite& b) {
    return a.parent == b.parent && a.offset == b.offset;
  };
  return names == other.names && parents == other.parents && offsets == other.offsets &&
         std::equal(endSites.begin(), endSites.end(), other.endSites.begin(), other.endSites.end(),
                    sameSite) &&
         std::equal(rest.begin(), rest.end(), other.rest.begin(), other.rest.end(),
                    [](const auto& a, const auto& b) { return a.coeffs() == b.coeffs(); });
}

void validate(const Skeleton& skeleton, const std::string& origin) {
  const size_t n = skeleton.names.size();
  if (n == 0) throw InputError({.path = origin}, "a skeleton with joints", "none");
  if (skeleton.parents.size() != n || skeleton.offsets.size() != n)
    throwInput({.path = origin}, fmt::format("a parent and an offset for each of {} joints", n),
               "{} parents, {} offsets", skeleton.parents.size(), skeleton.offsets.size());
  for (size_t j = 0; j < n; ++j) {
    const Place place{.path = origin, .item = "joint '" + skeleton.names[j] + "'"};
    const int parent = skeleton.parents[j];
    const bool ordered = j == 0 ? parent == -1 : parent >= 0 && parent < static_cast<int>(j);
    if (!ordered) throwInput(place, "a parent that comes before it", "parent {}", parent);
    if (!skeleton.offsets[j].allFinite())
      throw InputError(place, "a finite offset", "NaN or infinity");
  }
  if (!skeleton.rest.empty() && skeleton.rest.size() != n)
    throwInput({.path = origin}, fmt::format("a rest rotation for each of {} joints, or none", n),
               "{}", skeleton.rest.size());
  for (const auto& q : skeleton.rest)
    if (!(std::abs(q.norm() - 1.f) < 1e-3f))
      throwInput({.path = origin}, "rest rotations of length 1", "{}", q.norm());
}

}  // namespace marey

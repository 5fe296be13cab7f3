#include "base/quantile.h"

#include <algorithm>
#include <limits>

namespace marey {

double sortedQuantile(std::span<const double> sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<size_t>(position);
  if (k + 1 >= sorted.size()) return sorted.back();
  return sorted[k] + (position - static_cast<double>(k)) * (sorted[k + 1] - sorted[k]);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto k = static_cast<size_t>(position);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(k);
  std::nth_element(values.begin(), below, values.end());
  if (k + 1 >= values.size()) return *below;
  const double above = *std::min_element(below + 1, values.end());
  return *below + (position - static_cast<double>(k)) * (above - *below);
}

}  // namespace marey

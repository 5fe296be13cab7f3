#include "stats/sample_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace marey::stats {
namespace {

void requireFinite(const std::vector<double>& values) {
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    throw InputError({.path = "sample"}, "finite values", "NaN or infinity");
}

}  // namespace

PooledSamples::PooledSamples(const std::vector<std::vector<double>>& groups,
                             const std::vector<std::vector<double>>& reference)
    : m_groups(groups.size()) {
  for (const auto* side : {&groups, &reference}) {
    size_t total = 0;
    for (const std::vector<double>& sample : *side) {
      requireFinite(sample);
      for (double v : sample) m_values.push_back({v, m_sizes.size()});
      m_sizes.push_back(static_cast<double>(sample.size()));
      total += sample.size();
    }
    if (total == 0) throw InputError({.path = "sample"}, "at least one value", "none");
  }
  std::sort(m_values.begin(), m_values.end(),
            [](const Value& a, const Value& b) { return a.value < b.value; });
}

SampleDistance PooledSamples::distance(const std::vector<double>& weights,
                                       const std::vector<double>& referenceWeights) const {
  // What a value adds to its side's distribution function; negative for the reference, so that
  // the running sum is the gap between the two.
  std::vector<double> steps(m_sizes.size(), 0.0);
  std::array<double, 2> totals = {0.0, 0.0};
  for (size_t g = 0; g < steps.size(); ++g) {
    const bool own = g < m_groups;
    steps[g] = own ? weights[g] : referenceWeights.empty() ? 1 : referenceWeights[g - m_groups];
    totals[own ? 0 : 1] += steps[g] * m_sizes[g];
  }
  if (totals[0] == 0.0 || totals[1] == 0.0) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  for (size_t g = 0; g < steps.size(); ++g)
    steps[g] *= g < m_groups ? 1.0 / totals[0] : -1.0 / totals[1];
  SampleDistance out;
  double gap = 0.0;
  for (size_t i = 0; i + 1 < m_values.size(); ++i) {
    gap += steps[m_values[i].group];
    const double width = m_values[i + 1].value - m_values[i].value;
    if (width == 0.0) continue;
    out.wasserstein += std::abs(gap) * width;
    out.kolmogorov = std::max(out.kolmogorov, std::abs(gap));
  }
  return out;
}

double wasserstein1(const std::vector<double>& a, const std::vector<double>& b) {
  return PooledSamples({a}, {b}).distance({1}).wasserstein;
}

double kolmogorovSmirnov(const std::vector<double>& a, const std::vector<double>& b) {
  return PooledSamples({a}, {b}).distance({1}).kolmogorov;
}

}  // namespace marey::stats

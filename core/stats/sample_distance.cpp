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

double silvermanBandwidth(const std::vector<double>& sorted) {
  const auto n = static_cast<double>(sorted.size());
  double mean = 0.0;
  for (double v : sorted) mean += v / n;
  double squares = 0.0;
  for (double v : sorted) squares += (v - mean) * (v - mean);
  const double deviation = std::sqrt(squares / std::max(1.0, n - 1.0));
  const double range = sortedQuantile(sorted, 0.75) - sortedQuantile(sorted, 0.25);
  const double spread = range > 0.0 ? std::min(deviation, range / 1.34) : deviation;
  // A sample of one value has no spread; its bump gets a width that can be seen.
  return spread > 0.0 ? 0.9 * spread * std::pow(n, -0.2) : std::max(1e-6, 0.01 * std::abs(mean));
}

}  // namespace

double sortedQuantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<size_t>(position);
  if (k + 1 >= sorted.size()) return sorted.back();
  return sorted[k] + (position - static_cast<double>(k)) * (sorted[k + 1] - sorted[k]);
}

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

Density kernelDensity(std::vector<double> samples, int points, double bandwidth) {
  if (samples.empty()) throw InputError({.path = "sample"}, "at least one value", "none");
  if (points < 2) throwInput({.path = "density"}, "at least 2 points", "{}", points);
  requireFinite(samples);
  std::sort(samples.begin(), samples.end());
  Density out;
  out.bandwidth = bandwidth > 0.0 ? bandwidth : silvermanBandwidth(samples);
  const double from = samples.front() - 3.0 * out.bandwidth;
  const double to = samples.back() + 3.0 * out.bandwidth;
  const double scale = 1.0 / (static_cast<double>(samples.size()) * out.bandwidth *
                              std::sqrt(2.0 * std::numbers::pi));
  for (int i = 0; i < points; ++i) {
    const double x = from + (to - from) * i / (points - 1);
    // Beyond 8 bandwidths a value adds less than a double can hold beside the others.
    const auto first = std::lower_bound(samples.begin(), samples.end(), x - 8.0 * out.bandwidth);
    double sum = 0.0;
    for (auto it = first; it != samples.end() && *it <= x + 8.0 * out.bandwidth; ++it) {
      const double u = (x - *it) / out.bandwidth;
      sum += std::exp(-0.5 * u * u);
    }
    out.x.push_back(x);
    out.y.push_back(scale * sum);
  }
  return out;
}

}  // namespace marey::stats

// Distances between samples of one number, exact on sorted samples.
#pragma once

#include <cstddef>
#include <vector>

namespace marey::stats {

/// 1-Wasserstein distance: the area between the two empirical distribution functions, in the
/// samples' unit. Throws InputError when a sample is empty or not finite.
double wasserstein1(const std::vector<double>& a, const std::vector<double>& b);
/// Two-sample Kolmogorov-Smirnov statistic: the largest gap between the two functions, in [0, 1].
double kolmogorovSmirnov(const std::vector<double>& a, const std::vector<double>& b);

struct SampleDistance {
  double wasserstein = 0.0;
  double kolmogorov = 0.0;
};

/// Two samples sorted together once, compared again and again with other weights of their groups
/// (clips): what a bootstrap needs.
class PooledSamples {
 public:
  /// One sample per clip on either side. Throws InputError when a side is empty or not finite.
  PooledSamples(const std::vector<std::vector<double>>& groups,
                const std::vector<std::vector<double>>& reference);
  /// Distances with every value of group i counted weights[i] times, and likewise those of the
  /// reference (empty: once each); NaN when a side weighs nothing.
  SampleDistance distance(const std::vector<double>& weights,
                          const std::vector<double>& referenceWeights = {}) const;

 private:
  struct Value {
    double value;
    size_t group;  ///< reference groups follow the others
  };
  std::vector<Value> m_values;
  std::vector<double> m_sizes;  ///< of every group
  size_t m_groups = 0;          ///< groups of the first side
};

}  // namespace marey::stats

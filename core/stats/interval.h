// Confidence intervals from bootstrap values.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace marey::stats {

struct Interval {
  std::optional<double> low, high;
};

/// 2.5 and 97.5 percentile of the finite values; none for fewer than two.
Interval percentileInterval(std::vector<double> values);

/// 95 % interval of a distance between two distributions, from its value d between samples of them
/// and its values d* between resamples of both. A distance between samples is too large: even two
/// samples of one distribution have one, and resampling adds to it once more, by b = mean(d*) - d.
/// Where noise alone makes the distance, it adds in squares, so that 2 d^2 - mean(d*^2) estimates
/// the squared distance without it. With w = t sqrt(n / (n - 1)), t the 97.5 % quantile of
/// Student's t for n - 1 degrees of freedom and n the clusters of the smaller side:
///   low  = the smaller of d - 2 b - w sd(d*) and sqrt(2 d^2 - mean(d*^2) - w sd(d*^2)), at least 0
///   high = d + w sqrt(sd(d*)^2 + b^2)
/// (negative squares as 0, b at least 0). None for n < 2 or fewer than two finite values. Marey's
/// own; `docs/statistics.md` says how often it holds the truth.
Interval distanceInterval(double distance, std::vector<double> resampled, size_t clusters);

}  // namespace marey::stats

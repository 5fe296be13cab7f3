// The value at a share of a sample, linear between order statistics (NumPy's default).
#pragma once

#include <span>
#include <vector>

namespace marey {

/// Of values in rising order; NaN where there are none.
double sortedQuantile(std::span<const double> sorted, double share);
/// Of values in any order; NaN where there are none.
double quantile(std::vector<double> values, double share);

}  // namespace marey

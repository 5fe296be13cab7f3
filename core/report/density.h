// Smooth densities of samples, for distribution panels.
#pragma once

#include <vector>

namespace marey::report {

struct DensityCurve {
  std::vector<double> x;
  std::vector<double> y;  ///< per unit of x; integrates to 1 over the whole line
};

/// Silverman's rule of thumb (1986, eq. 3.31): 0.9 min(sd, IQR / 1.34) n^(-1/5), with the sample
/// standard deviation and linearly interpolated quartiles; the other one where one is zero, and
/// 1e-3 of the size of the values (at least 1e-6) where both are. Throws NumericError on no values.
double silvermanBandwidth(const std::vector<double>& values);

/// Gaussian kernel density at `points` places from low to high. Where no value is negative, mass
/// that would leak below zero is reflected. Values that are not finite are left out.
/// Throws NumericError on no finite values, low >= high or fewer than two points.
DensityCurve kernelDensity(const std::vector<double>& values, double low, double high, int points);

}  // namespace marey::report

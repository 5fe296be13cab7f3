#include "report/density.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/quantile.h"

namespace marey::report {

namespace {
std::vector<double> finiteValues(const std::vector<double>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double v) { return std::isfinite(v); });
  if (finite.empty()) throw NumericError("a density needs at least one finite value");
  return finite;
}

double standardDeviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// Values counted into narrow bins, shared between the two nearest bin centres: the cost of the
/// kernel then depends on the bins, not on the number of values.
struct Bins {
  double low, width;
  std::vector<double> weight;

  Bins(const std::vector<double>& values, double binWidth) : width(binWidth) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    low = *least;
    weight.assign(static_cast<size_t>((*most - *least) / width) + 2, 0.0);
    for (const double v : values) {
      const double at = (v - low) / width;
      const auto left = static_cast<size_t>(at);
      weight[left] += 1.0 - (at - static_cast<double>(left));
      weight[left + 1] += at - static_cast<double>(left);
    }
  }
  double centre(size_t i) const { return low + static_cast<double>(i) * width; }

  double kernelSum(double x, double bandwidth) const {
    constexpr double reach = 6.0;  // beyond six sigma a Gaussian adds nothing
    const auto bin = [&](double v) {
      return static_cast<size_t>(
          std::clamp((v - low) / width, 0.0, static_cast<double>(weight.size())));
    };
    double sum = 0.0;
    for (size_t i = bin(x - reach * bandwidth); i < bin(x + reach * bandwidth + width); ++i) {
      const double u = (x - centre(i)) / bandwidth;
      sum += weight[i] * std::exp(-0.5 * u * u);
    }
    return sum;
  }
};
}  // namespace

double silvermanBandwidth(const std::vector<double>& values) {
  if (values.empty()) throw NumericError("a bandwidth needs at least one value");
  const double deviation = standardDeviation(values);
  const double spread = (quantile(values, 0.75) - quantile(values, 0.25)) / 1.34;
  double scale = std::min(deviation, spread);
  if (scale <= 0.0) scale = std::max(deviation, spread);
  if (scale <= 0.0) return std::max(1e-6, 1e-3 * std::abs(values.front()));
  return 0.9 * scale * std::pow(static_cast<double>(values.size()), -0.2);
}

DensityCurve kernelDensity(const std::vector<double>& values, double low, double high, int points) {
  if (!(low < high) || points < 2) throw NumericError("a density needs a range and two points");
  const std::vector<double> finite = finiteValues(values);
  const double bandwidth = silvermanBandwidth(finite);
  const double extent = *std::max_element(finite.begin(), finite.end()) -
                        *std::min_element(finite.begin(), finite.end());
  // A few outliers far away must not ask for millions of bins.
  const Bins bins(finite, std::max({bandwidth / 12.0, extent / 200000.0, 1e-9}));
  const bool reflect = *std::min_element(finite.begin(), finite.end()) >= 0.0;
  const double norm =
      1.0 / (bandwidth * std::sqrt(2.0 * M_PI) * static_cast<double>(finite.size()));
  DensityCurve curve;
  for (int i = 0; i < points; ++i) {
    const double x = low + (high - low) * i / (points - 1);
    double sum = bins.kernelSum(x, bandwidth);
    if (reflect) sum = x < 0.0 ? 0.0 : sum + bins.kernelSum(-x, bandwidth);
    curve.x.push_back(x);
    curve.y.push_back(norm * sum);
  }
  return curve;
}

}  // namespace marey::report

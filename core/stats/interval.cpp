#include "stats/interval.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "base/quantile.h"
#include "stats/sample_distance.h"

namespace marey::stats {
namespace {

std::vector<double> finiteOf(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return values;
}

struct Spread {
  double mean = 0.0, deviation = 0.0;
};

Spread spreadOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Spread out;
  for (const double v : values) out.mean += v / n;
  for (const double v : values) out.deviation += (v - out.mean) * (v - out.mean) / (n - 1.0);
  out.deviation = std::sqrt(out.deviation);
  return out;
}

}  // namespace

Interval percentileInterval(std::vector<double> values) {
  values = finiteOf(std::move(values));
  if (values.size() < 2) return {};
  std::sort(values.begin(), values.end());
  return {sortedQuantile(values, 0.025), sortedQuantile(values, 0.975)};
}

Interval distanceInterval(double distance, std::vector<double> resampled, size_t clusters) {
  resampled = finiteOf(std::move(resampled));
  if (clusters < 2 || resampled.size() < 2 || !std::isfinite(distance)) return {};
  const auto n = static_cast<double>(clusters);
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
  const double wide = t * std::sqrt(n / (n - 1.0));
  const Spread plain = spreadOf(resampled);
  for (double& d : resampled) d *= d;
  const Spread squared = spreadOf(resampled);
  const double bias = std::max(0.0, plain.mean - distance);
  const double lowSquare = 2.0 * distance * distance - squared.mean - wide * squared.deviation;
  const double low =
      std::min(distance - 2.0 * bias - wide * plain.deviation, std::sqrt(std::max(0.0, lowSquare)));
  return {std::max(0.0, low), distance + wide * std::hypot(plain.deviation, bias)};
}

}  // namespace marey::stats

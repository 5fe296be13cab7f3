#include "render/chart/ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace marey::render {

namespace {
double niceStep(double roughStep) {
  const double power = std::pow(10.0, std::floor(std::log10(roughStep)));
  const double fraction = roughStep / power;
  // The thresholds are the geometric means between neighbours, so the number of ticks is as near
  // to the wanted one as round steps allow.
  if (fraction < std::sqrt(2.0)) return power;
  if (fraction < std::sqrt(10.0)) return 2.0 * power;
  if (fraction < std::sqrt(50.0)) return 5.0 * power;
  return 10.0 * power;
}

std::string tickLabel(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  return value < 0.0 ? "\u2212" + text : text;
}
}  // namespace

Ticks niceTicks(double low, double high, int wanted) {
  Ticks ticks;
  ticks.step = niceStep((high - low) / std::max(1, wanted));
  const int decimals =
      std::clamp(static_cast<int>(std::ceil(-std::log10(ticks.step) - 1e-9)), 0, 9);
  const auto first = static_cast<long long>(std::ceil(low / ticks.step - 1e-9));
  const auto last = static_cast<long long>(std::floor(high / ticks.step + 1e-9));
  for (long long k = first; k <= last; ++k) {
    ticks.values.push_back(static_cast<double>(k) * ticks.step);
    ticks.labels.push_back(tickLabel(ticks.values.back(), decimals));
  }
  return ticks;
}

}  // namespace marey::render

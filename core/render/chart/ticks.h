// Axis ticks at round values.
#pragma once

#include <string>
#include <vector>

namespace marey::render {

struct Ticks {
  std::vector<double> values;       ///< inside [low, high], rising
  std::vector<std::string> labels;  ///< all with the same number of decimals, true minus sign
  double step = 1.0;                ///< 1, 2 or 5 times a power of ten
};

/// About `wanted` ticks between low and high (low < high).
Ticks niceTicks(double low, double high, int wanted);

}  // namespace marey::render

// Weighted sums over clips: how most statistics are put together.
#pragma once

#include <functional>
#include <vector>

#include "stats/statistic.h"

namespace marey::stats {

/// Numerator and denominator that one clip adds to a ratio.
struct RatioPart {
  double sum = 0.0;
  double count = 0.0;
};

/// finish(sum / count) over the weighted clips; NaN where the count is zero.
WeightedValue weightedRatio(const std::vector<Clip>& clips,
                            const std::function<RatioPart(const Clip&)>& part,
                            const std::function<double(double)>& finish = {});

}  // namespace marey::stats

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

/// A rule whose parts are RatioParts, and finish(sum / count) over weighted ones; NaN where the
/// count is zero.
std::shared_ptr<const PartRule> ratioRule(
    std::function<RatioPart(const Clip&, size_t index, const StatisticSetting&)> part);
WeightedValue weightedRatio(const std::vector<ClipPart>& parts,
                            const std::function<double(double)>& finish = {});
/// Statistic::combine by it.
std::function<WeightedValue(const std::vector<ClipPart>&, const std::vector<ClipPart>&,
                            const StatisticSetting&)>
combineRatio(std::function<double(double)> finish = {});

}  // namespace marey::stats

// Intervals of distances: their formula by hand, and how often they hold the truth.
#include "stats/interval.h"

#include <cmath>

#include "unit/stats/coverage.h"
#include <gtest/gtest.h>

namespace marey::stats {
namespace {

TEST(DistanceInterval, IsTheFormulaOfItsHeader) {
  // d* = 2 and 4: mean 3, sd sqrt 2; squares 4 and 16: mean 10, sd 6 sqrt 2. d = 2.9 has b = 0.1.
  // n = 21: t = 2.085963 (20 degrees of freedom), w = t sqrt(21 / 20) = 2.137477.
  const double w = 2.137477;
  const Interval i = distanceInterval(2.9, {2.0, 4.0}, 21);
  EXPECT_EQ(*i.low, 0.0);  // 2.9 - 0.2 - 3.02 < 0
  EXPECT_NEAR(*i.high, 2.9 + w * std::sqrt(2.0 + 0.01), 1e-5);
  // Narrow values: d = 10, d* = 10.1 and 10.3: b = 0.2, sd 0.141421; squares 102.01 and 106.09:
  // mean 104.05, sd 2.884996. First lower end 10 - 0.4 - w 0.141421 = 9.297715, second
  // sqrt(200 - 104.05 - w 2.884996) = 9.475...
  const Interval narrow = distanceInterval(10.0, {10.1, 10.3}, 21);
  EXPECT_NEAR(*narrow.low, 10.0 - 0.4 - w * 0.14142136, 1e-5);
  EXPECT_NEAR(*narrow.high, 10.0 + w * std::sqrt(0.02 + 0.04), 1e-5);
}

TEST(DistanceInterval, OfOneClusterOrOneValueThereIsNone) {
  EXPECT_FALSE(distanceInterval(1.0, {1.0, 2.0}, 1).low.has_value());
  EXPECT_FALSE(distanceInterval(1.0, {1.0, std::nan("")}, 5).low.has_value());
}

TEST(PercentileInterval, LeavesOutWhatIsNoNumber) {
  const Interval i = percentileInterval({std::nan(""), 0.0, 1.0});
  EXPECT_NEAR(*i.low, 0.025, 1e-12);
  EXPECT_NEAR(*i.high, 0.975, 1e-12);
}

/// A share that is between 93 and 97 % in the long run is found between these, but for one time in
/// a hundred, in so many replications.
constexpr int kReplications = 300;
double slack(double share) {
  return 2.576 * std::sqrt(share * (1.0 - share) / kReplications);
}

// Distances that stand out from the noise: 93 to 97 % of the intervals hold them.
TEST(DistanceInterval, HoldsAClearDistanceNinetyFiveTimesInAHundred) {
  for (const bool paired : {false, true}) {
    const Coverage found = coverageOf({.controls = 30, .paired = paired, .joints = 4, .shift = 1.5},
                                      kReplications, 150, 11);
    EXPECT_GE(found.wasserstein, 0.93 - slack(0.93)) << paired;
    EXPECT_LE(found.wasserstein, 0.97 + slack(0.97)) << paired;
    EXPECT_GE(found.kolmogorov, 0.93 - slack(0.93)) << paired;
    EXPECT_LE(found.kolmogorov, 0.97 + slack(0.97)) << paired;
  }
}

// Distances within the noise, as of a perfect model: intervals reach down to zero, and hold the
// truth more often.
TEST(DistanceInterval, HoldsADistanceWithinTheNoiseAtLeastAsOften) {
  for (const double shift : {0.0, 0.2}) {
    const Coverage found = coverageOf({.controls = 30, .paired = true, .joints = 4, .shift = shift},
                                      kReplications, 150, 12);
    EXPECT_GE(found.wasserstein, 0.93 - slack(0.93)) << shift;
    EXPECT_GE(found.kolmogorov, 0.93 - slack(0.93)) << shift;
  }
}

// Five samples along a control are no more evidence than their control.
TEST(DistanceInterval, HoldsItWithSeveralSamplesPerControl) {
  const Coverage found = coverageOf(
      {.controls = 30, .paired = true, .joints = 2, .samples = 5, .frames = 4, .shift = 1.0},
      kReplications, 150, 13);
  EXPECT_GE(found.wasserstein, 0.93 - slack(0.93));
  EXPECT_GE(found.kolmogorov, 0.93 - slack(0.93));
}

}  // namespace
}  // namespace marey::stats

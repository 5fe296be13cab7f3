#include "stats/sample_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/quantile.h"

namespace marey::stats {
namespace {

const std::vector<double> kA = {0.1, 0.5, 0.5, 1.7, 2.2, 3.1, -0.4};
const std::vector<double> kB = {0.5, 0.9, 1.1, 2.9, 4.0};

TEST(SampleDistance, AgreesWithSciPy) {
  // scipy.stats.wasserstein_distance(a, b) and ks_2samp(a, b).statistic, SciPy 1.10.
  EXPECT_NEAR(wasserstein1(kA, kB), 0.8142857142857142, 1e-14);
  EXPECT_NEAR(kolmogorovSmirnov(kA, kB), 0.37142857142857144, 1e-14);
}

TEST(SampleDistance, OfAShiftedSampleIsTheShift) {
  std::vector<double> shifted = kA;
  for (double& v : shifted) v += 2.5;
  EXPECT_NEAR(wasserstein1(kA, shifted), 2.5, 1e-12);
}

TEST(SampleDistance, IsZeroForTheSameSampleAndOneForSeparateOnes) {
  EXPECT_EQ(wasserstein1(kA, kA), 0.0);
  EXPECT_EQ(kolmogorovSmirnov(kA, kA), 0.0);
  EXPECT_EQ(kolmogorovSmirnov({1.0, 2.0}, {3.0}), 1.0);
}

TEST(SampleDistance, IsSymmetric) {
  EXPECT_NEAR(wasserstein1(kA, kB), wasserstein1(kB, kA), 1e-15);
  EXPECT_NEAR(kolmogorovSmirnov(kA, kB), kolmogorovSmirnov(kB, kA), 1e-15);
}

TEST(SampleDistance, WeightsRepeatGroupsOfEitherSide) {
  const std::vector<std::vector<double>> groups = {{0.0, 1.0}, {5.0}, {7.0, 7.5}};
  const PooledSamples pool(groups, {{2.0}, {3.0, 4.0}});
  const SampleDistance weighted = pool.distance({2, 0, 1}, {1, 3});
  const std::vector<double> a = {0.0, 1.0, 0.0, 1.0, 7.0, 7.5};
  const std::vector<double> b = {2.0, 3.0, 4.0, 3.0, 4.0, 3.0, 4.0};
  EXPECT_NEAR(weighted.wasserstein, wasserstein1(a, b), 1e-12);
  EXPECT_NEAR(weighted.kolmogorov, kolmogorovSmirnov(a, b), 1e-12);
  EXPECT_TRUE(std::isnan(pool.distance({0, 0, 0}).wasserstein));
}

TEST(SampleDistance, EmptyOrInfiniteSamplesAreRefused) {
  EXPECT_THROW(wasserstein1({}, kB), InputError);
  EXPECT_THROW(wasserstein1(kA, {}), InputError);
  EXPECT_THROW(kolmogorovSmirnov(kA, {NAN}), InputError);
}

TEST(Quantile, AgreesWithNumPy) {
  // numpy.quantile(a, [.025, .5, .975]), linear.
  std::vector<double> sorted = {-0.4, 0.1, 0.5, 0.5, 1.7, 2.2, 3.1};
  EXPECT_NEAR(sortedQuantile(sorted, 0.025), -0.325, 1e-12);
  EXPECT_NEAR(sortedQuantile(sorted, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(sortedQuantile(sorted, 0.975), 2.965, 1e-12);
}

}  // namespace
}  // namespace marey::stats

#include "stats/sample_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

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

TEST(KernelDensity, AgreesWithSciPyAtSilvermansBandwidth) {
  // h = 0.9 min(std(ddof=1), IQR/1.34) n^-0.2 by NumPy; gaussian_kde(a, bw_method=h/std)(x).
  const Density density = kernelDensity(kA, 2001);
  EXPECT_NEAR(density.bandwidth, 0.7509344823878465, 1e-12);
  const auto at = [&](double x) {
    size_t k = 0;
    while (density.x[k + 1] <= x) ++k;
    const double u = (x - density.x[k]) / (density.x[k + 1] - density.x[k]);
    return density.y[k] + u * (density.y[k + 1] - density.y[k]);
  };
  EXPECT_NEAR(at(0.5), 0.2818635844534859, 1e-5);
  EXPECT_NEAR(at(2.0), 0.1934757860518323, 1e-5);
}

TEST(KernelDensity, HasAnAreaOfOne) {
  const Density density = kernelDensity({1.0, 2.0, 2.5, 9.0}, 4000);
  double area = 0.0;
  for (size_t i = 1; i < density.x.size(); ++i)
    area += 0.5 * (density.y[i] + density.y[i - 1]) * (density.x[i] - density.x[i - 1]);
  // Three bandwidths beyond the ends 0.3 % of two bumps are cut off.
  EXPECT_NEAR(area, 1.0, 0.003);
}

TEST(KernelDensity, OfOneValueIsANarrowBump) {
  const Density density = kernelDensity({4.0, 4.0, 4.0}, 101);
  EXPECT_GT(density.bandwidth, 0.0);
  EXPECT_NEAR(density.x[50], 4.0, 1e-9);
  EXPECT_GT(density.y[50], density.y[10]);
  EXPECT_THROW(kernelDensity({}, 10), InputError);
  EXPECT_THROW(kernelDensity({1.0}, 1), InputError);
}

}  // namespace
}  // namespace marey::stats

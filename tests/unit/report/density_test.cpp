#include "report/density.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/quantile.h"
#include "base/random.h"

namespace marey::report {
namespace {

const std::vector<double> mixedSigns = {1.0, 2.0, 2.5, 4.0, 7.0, -3.0};

// numpy: 0.9 * min(v.std(ddof=1), iqr / 1.34) * n ** -0.2 with np.percentile quartiles.
TEST(Density, BandwidthIsSilvermansRule) {
  EXPECT_NEAR(silvermanBandwidth(mixedSigns), 1.1147335569957093, 1e-12);
}

// scipy.stats.gaussian_kde(v, bw_method=bandwidth / v.std(ddof=1)) at -3, 0, 2.25 and 8; values are
// binned here to a twelfth of the bandwidth, which is worth 1e-3 of the density.
TEST(Density, AgreesWithScipy) {
  const DensityCurve curve = kernelDensity(mixedSigns, -3.0, 8.0, 45);  // every 0.25
  EXPECT_NEAR(curve.y[0], 0.05974516, 1e-4);
  EXPECT_NEAR(curve.y[12], 0.05833137, 1e-4);
  EXPECT_NEAR(curve.y[21], 0.16554232, 3e-4);
  EXPECT_NEAR(curve.y[44], 0.03998353, 1e-4);
}

// scipy, as above, with k(x) + k(-x) for values that are never negative.
TEST(Density, QuantitiesThatAreNeverNegativeAreReflectedAtZero) {
  const DensityCurve curve = kernelDensity({0.1, 0.5, 0.4, 2.0, 1.0}, 0.0, 3.0, 11);  // every 0.3
  EXPECT_NEAR(curve.y[0], 0.85692099, 2e-3);
  EXPECT_NEAR(curve.y[1], 0.83409578, 2e-3);
  EXPECT_NEAR(curve.y[5], 0.12722368, 1e-3);
}

TEST(Density, IntegratesToOneForManyValues) {
  std::vector<float> normal(20000);
  fillNormal({.seed = 4, .stage = RandomStage::Test}, normal);
  const DensityCurve curve = kernelDensity({normal.begin(), normal.end()}, -6.0, 6.0, 601);
  double area = 0.0;
  for (const double y : curve.y) area += 0.02 * y;
  EXPECT_NEAR(area, 1.0, 1e-3);
  EXPECT_NEAR(curve.y[300], 1.0 / std::sqrt(2.0 * M_PI), 0.02);
}

TEST(Density, EqualValuesAndOutliersFarAwayAreNoTrouble) {
  const DensityCurve peak = kernelDensity(std::vector<double>(50, 2.0), 1.0, 3.0, 101);
  EXPECT_GT(peak.y[50], peak.y[40]);
  std::vector<double> far(1000, 1.0);
  far[0] = 1e12;
  far[1] = 1.5;
  EXPECT_TRUE(std::isfinite(kernelDensity(far, 0.0, 3.0, 20).y[7]));
}

TEST(Density, ValuesThatAreNotFiniteAreLeftOut) {
  std::vector<double> values = mixedSigns;
  values.push_back(NAN);
  values.push_back(INFINITY);
  EXPECT_EQ(kernelDensity(values, -3, 8, 10).y, kernelDensity(mixedSigns, -3, 8, 10).y);
  EXPECT_THROW(kernelDensity({NAN}, 0, 1, 10), NumericError);
  EXPECT_THROW(kernelDensity(mixedSigns, 1, 1, 10), NumericError);
}

// numpy.percentile([3, 1, 2, 10], [5, 50, 95]) = [1.15, 2.5, 8.95]
TEST(Density, QuantilesAreThoseOfNumpy) {
  const std::vector<double> values = {3, 1, 2, 10};
  EXPECT_NEAR(quantile(values, 0.05), 1.15, 1e-12);
  EXPECT_NEAR(quantile(values, 0.5), 2.5, 1e-12);
  EXPECT_NEAR(quantile(values, 0.95), 8.95, 1e-12);
  EXPECT_EQ(quantile(values, 1.0), 10.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace marey::report

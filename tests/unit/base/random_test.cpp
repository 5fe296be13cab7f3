#include "base/random.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

using Words = std::array<uint32_t, 4>;

// The known answers of Random123 (file kat_vectors, philox4x32 with 10 rounds).
TEST(Philox, GivesThePublishedAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

struct Moments {
  double mean = 0.0, variance = 0.0, skewness = 0.0, kurtosis = 0.0;
};

template <typename T>
Moments momentsOf(const std::vector<T>& values) {
  Moments out;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) out.mean += v / n;
  for (const double v : values) {
    const double d = v - out.mean;
    out.variance += d * d / n;
    out.skewness += d * d * d / n;
    out.kurtosis += d * d * d * d / n;
  }
  out.skewness /= std::pow(out.variance, 1.5);
  out.kurtosis /= out.variance * out.variance;
  return out;
}

TEST(NormalNumbers, HaveTheMomentsOfTheStandardNormal) {
  std::vector<float> values(200'000);
  fillNormal({.seed = 11, .stage = RandomStage::Test}, values);
  const Moments m = momentsOf(values);
  // Five standard errors: sqrt(1/n), sqrt(2/n), sqrt(6/n), sqrt(24/n).
  EXPECT_NEAR(m.mean, 0.0, 5 * std::sqrt(1.0 / 200'000));
  EXPECT_NEAR(m.variance, 1.0, 5 * std::sqrt(2.0 / 200'000));
  EXPECT_NEAR(m.skewness, 0.0, 5 * std::sqrt(6.0 / 200'000));
  EXPECT_NEAR(m.kurtosis, 3.0, 5 * std::sqrt(24.0 / 200'000));
}

TEST(NormalNumbers, FollowTheNormalDistributionFunction) {
  std::vector<float> values(100'000);
  fillNormal({.seed = 5, .sample = 3, .stage = RandomStage::Test}, values);
  std::sort(values.begin(), values.end());
  double distance = 0.0;  // Kolmogorov-Smirnov
  for (size_t i = 0; i < values.size(); ++i) {
    const double expected = 0.5 * std::erfc(-values[i] / std::sqrt(2.0));
    const double n = static_cast<double>(values.size());
    distance = std::max({distance, std::fabs(expected - static_cast<double>(i) / n),
                         std::fabs(expected - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(100'000.0));  // p = 0.001
}

TEST(UniformNumbers, FillTheUnitIntervalEvenly) {
  std::vector<double> values(160'000);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = uniformAt({.seed = 2, .stage = RandomStage::Test}, static_cast<uint32_t>(i));
  std::vector<int> bins(16, 0);
  for (const double v : values) {
    ASSERT_GE(v, 0.0);
    ASSERT_LT(v, 1.0);
    ++bins[static_cast<size_t>(v * 16)];
  }
  double chiSquare = 0.0;
  for (const int n : bins) chiSquare += (n - 10'000.0) * (n - 10'000.0) / 10'000.0;
  EXPECT_LT(chiSquare, 37.7);  // 15 degrees of freedom, p = 0.001
}

TEST(Streams, GiveTheSameNumbersWhateverTheirLength) {
  const RandomKey key{.seed = 9, .sample = 1, .frame = 7, .stage = RandomStage::Test};
  std::vector<float> all(103);
  fillNormal(key, all);
  for (const size_t length : {1u, 2u, 5u, 64u, 102u}) {
    std::vector<float> part(length);
    fillNormal(key, part);
    EXPECT_TRUE(std::equal(part.begin(), part.end(), all.begin())) << length;
  }
  for (uint32_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(static_cast<float>(normalAt(key, i)), all[i]) << i;
}

TEST(Streams, DifferInEveryPartOfTheirKey) {
  const RandomKey base{.seed = 1, .sample = 1, .frame = 1, .stage = RandomStage::Test};
  std::vector<RandomKey> keys(6, base);
  keys[1].seed = 2;
  keys[2].seed = 1 + (uint64_t{1} << 32);
  keys[3].sample = 2;
  keys[4].frame = 2;
  keys[5].stage = RandomStage::Latent;
  std::set<double> first;
  for (const auto& key : keys) first.insert(uniformAt(key, 0));
  EXPECT_EQ(first.size(), keys.size());
}

TEST(Streams, OfNeighbouringFramesAndSamplesAreUncorrelated) {
  constexpr size_t kCount = 40'000;
  std::vector<float> base(kCount), frame(kCount), sample(kCount);
  fillNormal({.seed = 4, .stage = RandomStage::Test}, base);
  fillNormal({.seed = 4, .frame = 1, .stage = RandomStage::Test}, frame);
  fillNormal({.seed = 4, .sample = 1, .stage = RandomStage::Test}, sample);
  double withFrame = 0.0, withSample = 0.0, withNext = 0.0;
  for (size_t i = 0; i < kCount; ++i) {
    withFrame += base[i] * frame[i] / kCount;
    withSample += base[i] * sample[i] / kCount;
    withNext += base[i] * base[(i + 1) % kCount] / kCount;
  }
  const double bound = 5.0 / std::sqrt(static_cast<double>(kCount));
  EXPECT_LT(std::fabs(withFrame), bound);
  EXPECT_LT(std::fabs(withSample), bound);
  EXPECT_LT(std::fabs(withNext), bound);
}

TEST(Streams, DoNotRepeatAfterTwentySixBits) {
  const RandomKey key{.seed = 1, .stage = RandomStage::Test};
  EXPECT_NE(uniformAt(key, 0), uniformAt(key, 1u << 26));
  EXPECT_NE(uniformAt(key, 5), uniformAt(key, 5 + (1u << 27)));
}

TEST(ChiSquaredNumbers, HaveMeanDfAndVarianceTwoDf) {
  for (const double df : {0.5, 1.0, 3.0, 50.0}) {
    constexpr uint32_t kCount = 40'000;
    std::vector<double> values;
    for (uint32_t i = 0; i < kCount; ++i)
      values.push_back(chiSquared({.seed = 8, .sample = i, .stage = RandomStage::Test}, df));
    const Moments m = momentsOf(values);
    EXPECT_NEAR(m.mean, df, 5 * std::sqrt(2 * df / kCount)) << df;
    // The variance of a sample variance is (kurtosis - 1) / n, kurtosis = 3 + 12 / df.
    EXPECT_NEAR(m.variance, 2 * df, 5 * 2 * df * std::sqrt((2 + 12 / df) / kCount)) << df;
  }
}

}  // namespace
}  // namespace marey

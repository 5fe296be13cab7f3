// Which clips are drawn together.
#include "stats/controls.h"

#include <numeric>

#include <gtest/gtest.h>

namespace marey::stats {
namespace {

double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Controls, OnceCountsEveryControlOnce) {
  const Weights w = ControlSets({5, 5, 8, 5, 8}, {8, 9}).once();
  EXPECT_EQ(w.clips, (std::vector<double>{1.0 / 3, 1.0 / 3, 0.5, 1.0 / 3, 0.5}));
  EXPECT_EQ(w.natural, (std::vector<double>{1, 1}));
}

TEST(Controls, APairIsDrawnAsOne) {
  // Controls 0..9 on both sides, two samples along each.
  std::vector<int> own, natural;
  for (int i = 0; i < 10; ++i) {
    own.insert(own.end(), {i, i});
    natural.push_back(i);
  }
  const ControlSets sets(own, natural);
  for (uint32_t r = 0; r < 50; ++r) {
    const Weights w = sets.drawn(1, r);
    for (size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(w.clips[2 * i], w.natural[i] / 2);
      EXPECT_EQ(w.clips[2 * i + 1], w.natural[i] / 2);
    }
    EXPECT_EQ(sumOf(w.natural), 10.0);
  }
}

TEST(Controls, OfOneSideAreDrawnAmongThemselves) {
  const ControlSets sets({0, 1, 2, 20}, {0, 1, 2, 10, 11});
  bool differs = false;
  for (uint32_t r = 0; r < 50; ++r) {
    const Weights w = sets.drawn(1, r);
    EXPECT_EQ(w.clips[0] + w.clips[1] + w.clips[2], 3.0);
    EXPECT_EQ(w.clips[3], 1.0);
    EXPECT_EQ(w.natural[3] + w.natural[4], 2.0);
    differs = differs || w.natural[3] != 1.0;
  }
  EXPECT_TRUE(differs);
}

TEST(Controls, TwoNaturalSetsAreOfTheSizesAtHandAndIndependent) {
  const ControlSets sets({0, 0, 1, 2}, {5, 6, 7, 8, 9, 10, 11});
  double product = 0.0;
  constexpr int kDraws = 4000;
  for (uint32_t r = 0; r < kDraws; ++r) {
    const Weights w = sets.bothNatural(3, r);
    ASSERT_EQ(w.clips.size(), 7U);
    EXPECT_EQ(sumOf(w.clips), 3.0);
    EXPECT_EQ(sumOf(w.natural), 7.0);
    product += (w.clips[0] - 3.0 / 7) * (w.natural[0] - 1.0) / kDraws;
  }
  // Zero for independent draws; the standard deviation of the mean is sqrt(3/7 6/7 6/7) /
  // sqrt(4000) = 0.009.
  EXPECT_NEAR(product, 0.0, 0.036);
}

TEST(Controls, TheSameSeedDrawsTheSame) {
  const ControlSets sets({0, 1, 2, 3, 4}, {5, 6, 7});
  EXPECT_EQ(sets.drawn(2, 7).clips, sets.drawn(2, 7).clips);
  EXPECT_NE(sets.drawn(2, 7).clips, sets.drawn(2, 8).clips);
  EXPECT_NE(sets.drawn(2, 7).clips, sets.drawn(3, 7).clips);
}

}  // namespace
}  // namespace marey::stats

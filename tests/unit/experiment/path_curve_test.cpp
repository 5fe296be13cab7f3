#include "experiment/path_curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "experiment/natural_pace.h"

namespace marey {
namespace {

TEST(PathCurve, ACircleIsWalkedAtOneSpeedAndOneTurnRate) {
  std::vector<RootFrame> frames;
  for (int i = 0; i <= 100; ++i) {
    const double a = 0.5 * i / 20.0;
    frames.push_back({2.0 * (1.0 - std::cos(a)), 2.0 * std::sin(a), a});
  }
  const PathCurve curve = curveOf(frames, 20.0);
  ASSERT_EQ(curve.speedMS.size(), frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_NEAR(curve.speedMS[i], 1.0, 1e-3);
    EXPECT_NEAR(curve.turnRadS[i], 0.5, 1e-9);
  }
  EXPECT_DOUBLE_EQ(curve.seconds(), 5.0);
}

TEST(PathCurve, ATurnAcrossTheSeamIsSmall) {
  const PathCurve curve = curveOf({{0, 0, 3.1}, {0, 0, -3.1}}, 1.0);
  EXPECT_NEAR(curve.turnRadS[1], 2.0 * 3.14159265358979 - 6.2, 1e-9);
}

TEST(PathCurve, AnEmptyPathHasNoValues) {
  const PathCurve curve = curveOf({}, 20.0);
  EXPECT_TRUE(curve.speedMS.empty());
  EXPECT_DOUBLE_EQ(curve.seconds(), 0.0);
  EXPECT_DOUBLE_EQ(curveOf({{1, 2, 3}}, 20.0).speedMS[0], 0.0);
}

TEST(PathCurve, SpreadsNameTheMiddleNinetyPercent) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const Spread spread = spreadOf(values);
  EXPECT_DOUBLE_EQ(spread.minimum, 0.0);
  EXPECT_DOUBLE_EQ(spread.low, 5.0);
  EXPECT_DOUBLE_EQ(spread.high, 95.0);
  EXPECT_DOUBLE_EQ(spread.maximum, 100.0);
  EXPECT_THROW(spreadOf({}), NumericError);
}

TEST(PathCurve, StrainTellsRareFromUnseen) {
  const PaceRange natural{.speedMS = {.minimum = 0.2, .low = 0.5, .high = 1.5, .maximum = 2.0},
                          .turnRadS = {.minimum = -1, .low = -0.5, .high = 0.5, .maximum = 1},
                          .clips = 1};
  EXPECT_EQ(strainOf(1.0, natural.speedMS), Strain::None);
  EXPECT_EQ(strainOf(1.8, natural.speedMS), Strain::Rare);
  EXPECT_EQ(strainOf(0.1, natural.speedMS), Strain::Unseen);
  // 1 m/s, and a turn of 0.8 rad/s in the last step.
  const PathCurve curve = curveOf({{0, 0, 0}, {0, 1, 0}, {0, 2, 0.8}}, 1.0);
  const auto strains = strainsOf(curve, natural);
  EXPECT_EQ(strains, (std::vector<Strain>{Strain::None, Strain::None, Strain::Rare}));
  EXPECT_EQ(strainsOf(curve, std::nullopt),
            (std::vector<Strain>{Strain::None, Strain::None, Strain::None}));
}

TEST(NaturalPace, OfTheTrainingDataGoesBeforeThatOfClips) {
  Progress progress;
  EXPECT_FALSE(naturalPace({}, {}, progress)) << "there is nothing to measure";
  const PaceModel none{"no model", MAREY_SOURCE_DIR "/README.md"};
  EXPECT_FALSE(naturalPace({none}, {}, progress)) << "a file that is no model is passed over";
  const PaceModel demo{"demo", MAREY_SOURCE_DIR "/resources/demo/demo.marey"};
  const auto pace = naturalPace({none, demo}, {}, progress);
  ASSERT_TRUE(pace);
  EXPECT_EQ(pace->model, "demo");
  EXPECT_EQ(pace->clips, 0U);
  // Walkers walk: they stand at least, and do not run.
  EXPECT_GE(pace->speedMS.minimum, 0.0);
  EXPECT_LT(pace->speedMS.maximum, 4.0);
}

}  // namespace
}  // namespace marey

// Skate, smoothness, path error and diversity on cases worked out by hand.
#include <cmath>
#include <numbers>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "stats/diversity.h"
#include "stats/skate.h"
#include "stats/trajectories.h"

namespace marey::stats {
namespace {

TEST(Skate, TheHeightWeightFallsFromOneToZeroAtTwoAndAHalfCentimetres) {
  // 100 cm/s at the floor, half of H, at H, above H: weights 1, 2 - sqrt 2, 0, 0.
  const Clip clip = pointClip({Vec3(0, 0, 0), Vec3(0.1f, 0, 0), Vec3(0.2f, 0.0125f, 0),
                               Vec3(0.3f, 0.025f, 0), Vec3(0.4f, 0.2f, 0)},
                              10.0);
  const SkateTally tally = heightWeightedSkate(clip, {0}, {0.0});
  EXPECT_EQ(tally.frames, 4.0);
  EXPECT_NEAR(tally.sum, 100.0 * (1.0 + 2.0 - std::numbers::sqrt2), 0.01);
}

TEST(Skate, TheShareCountsFastLowFramesOfAnyFoot) {
  // 20 fps: 3 cm per frame are 60 cm/s (skates), 2 cm are 40 cm/s (does not), then a lifted foot.
  const Clip clip = pointClip({Vec3(0, 0, 0), Vec3(0.03f, 0, 0), Vec3(0.05f, 0, 0),
                               Vec3(0.15f, 0.1f, 0), Vec3(0.25f, 0, 0)},
                              20.0);
  const SkateTally tally = skatingShare(clip, {0}, {0.0});
  EXPECT_EQ(tally.frames, 4.0);
  EXPECT_EQ(tally.sum, 1.0);
  EXPECT_EQ(skatingShare(clip, {0, 0}, {0.0, 0.0}).sum, 1.0);
}

TEST(Skate, ContactIsASquaredDisplacementBelowTheLaFanFactor) {
  // 0.14 cm in a thirtieth of a second: 0.0196 cm^2 < 0.02; 0.142 cm: 0.0202 cm^2.
  EXPECT_EQ(contactShare(stepClip({0.0014f, 0.00142f}, 30.0), {0}).sum, 1.0);
  // The same speed at twice the rate is judged alike.
  EXPECT_EQ(contactShare(stepClip({0.0007f, 0.00071f}, 60.0), {0}).sum, 1.0);
}

TEST(Skate, StandingHeightIsTheFifthPercentile) {
  std::vector<Vec3> positions;
  for (int i = 0; i <= 100; ++i) positions.emplace_back(0, 0.01f * static_cast<float>(i), 0);
  EXPECT_NEAR(standingHeights({pointClip(positions, 10.0)}, {0})[0], 0.05, 1e-6);
}

TEST(Skate, AWalkerWithPlantedFeetSkatesLittleAndADraggedOneMuch) {
  Clip clip = walk(presetPath("slow", 6.0, 60.0), {.fps = 60.0}).clip;
  const std::vector<int> feet = {3, 7};
  const auto heights = standingHeights({clip}, feet);
  const auto value = [&](const Clip& c) {
    const SkateTally tally = heightWeightedSkate(c, feet, heights);
    return tally.sum / tally.frames;
  };
  const double planted = value(clip);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (Vec3& p : clip.frame(t)) p.z() += 0.5f * static_cast<float>(t) / 60.0f;
  EXPECT_GT(value(clip), planted + 20.0);
}

TEST(Jerk, OfACubicIsSixTimesItsFactorAtAnyRate) {
  for (double fps : {20.0, 50.0}) {
    std::vector<Vec3> positions;
    for (int t = 0; t < 20; ++t)
      positions.emplace_back(static_cast<float>(2.0 * std::pow(t / fps, 3)), 0, 1);
    const JerkTally tally = jerk(pointClip(positions, fps));
    EXPECT_EQ(tally.count, 17.0);
    EXPECT_NEAR(tally.sum / tally.count, 12.0, 0.05);
  }
}

TEST(Jerk, OfThreeFramesIsNothing) {
  EXPECT_EQ(jerk(stepClip({0.1f, 0.2f}, 20.0)).count, 0.0);
}

TEST(PathError, IsTheDistanceAtEqualTimes) {
  const std::vector<RootFrame> wanted = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}};
  const std::vector<RootFrame> walked = {
      {0, 0, 0}, {3, 5, 0.3}, {0, 2.5, -0.3 + 2 * std::numbers::pi}};
  const PathError error = pathError(walked, wanted);
  EXPECT_NEAR(error.meanM, 5.5 / 3.0, 1e-12);
  EXPECT_NEAR(error.maximumM, 5.0, 1e-12);
  EXPECT_NEAR(error.finalM, 0.5, 1e-12);
  EXPECT_NEAR(error.headingMeanRad, 0.2, 1e-12);
  EXPECT_THROW(pathError({}, wanted), InputError);
}

TEST(Diversity, IsZeroForCopiesWhereverTheyWalk) {
  const Clip clip = walk(presetPath("slow", 3.0, 20.0), {.fps = 20.0}).clip;
  Clip moved = clip;
  for (Vec3& p : moved.positions) p = Vec3(p.z() + 3.0f, p.y(), -p.x());
  const auto distances = pairDistances({clip, moved});
  EXPECT_NEAR(distances[1], 0.0, 1e-4);
}

TEST(Diversity, OfARaisedCopyIsTheRise) {
  const Clip clip = walk(presetPath("slow", 3.0, 20.0), {.fps = 20.0}).clip;
  Clip raised = clip;
  for (Vec3& p : raised.positions) p.y() += 0.3f;
  const auto distances = pairDistances({clip, raised, clip});
  EXPECT_NEAR(distances[1], 0.3, 1e-4);
  EXPECT_NEAR(distances[5], 0.3, 1e-4);
  // Pairs: 0.3, 0, 0.3; with the first clip twice: (2 x 0.3 + 2 x 0 + 0.3) / 5.
  EXPECT_NEAR(meanPairDistance(distances, {1, 1, 1}), 0.2, 1e-4);
  EXPECT_NEAR(meanPairDistance(distances, {2, 1, 1}), 0.18, 1e-4);
  EXPECT_TRUE(std::isnan(meanPairDistance(distances, {3, 0, 0})));
}

TEST(Diversity, SpreadsTheClipsThatItKeeps) {
  EXPECT_EQ(spreadIndices(3, 10), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(spreadIndices(10, 5), (std::vector<int>{0, 2, 4, 6, 8}));
}

}  // namespace
}  // namespace marey::stats

// Skate, smoothness, path error and diversity on cases worked out by hand.
#include <cmath>
#include <numbers>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "stats/diversity.h"
#include "stats/footsteps.h"
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

TEST(Skate, TheShareCountsLowFramesThatAreFastNowAndInTheMeanOfFive) {
  // 20 fps, 4 cm per frame are 80 cm/s. One slip alone: the mean of five is 16 cm/s.
  EXPECT_EQ(skatingShare(stepClip({0, 0, 0, 0.04f, 0, 0, 0}, 20.0), {0}).sum, 0.0);
  // A slide of five: means 48, 64, 80, 64, 48 cm/s with zeros about; the middle three skate.
  const SkateTally slide =
      skatingShare(stepClip({0, 0, 0.04f, 0.04f, 0.04f, 0.04f, 0.04f, 0, 0}, 20.0), {0});
  EXPECT_EQ(slide.frames, 9.0);
  EXPECT_EQ(slide.sum, 3.0);
  // Beyond the ends of the clip there are zeros: of four fast frames alone the middle two.
  EXPECT_EQ(skatingShare(stepClip({0.04f, 0.04f, 0.04f, 0.04f}, 20.0), {0}).sum, 2.0);
  // Either toe: the same frames count once.
  EXPECT_EQ(skatingShare(stepClip({0.04f, 0.04f, 0.04f, 0.04f}, 20.0), {0, 0}).sum, 2.0);
}

TEST(Skate, AToeThatIsHighInEitherFrameDoesNotSkate) {
  Clip clip = stepClip({0.04f, 0.04f, 0.04f, 0.04f, 0.04f}, 20.0);
  EXPECT_EQ(skatingShare(clip, {0}).sum, 3.0);
  clip.positions[3].y() = 0.06f;  // spoils frames 3 and 4
  EXPECT_EQ(skatingShare(clip, {0}).sum, 1.0);
  for (Vec3& p : clip.positions) p.y() = 0.1f;  // heights are absolute
  EXPECT_EQ(skatingShare(clip, {0}).sum, 0.0);
}

TEST(Skate, ToesAreTheJointsBelowTheFeetThatAreNamedSoOrAreAlone) {
  Skeleton s;
  s.names = {"hips", "ankle", "heel", "LeftToeBase", "foot", "ball", "paw", "a", "b"};
  s.parents = {-1, 0, 1, 1, 0, 4, 0, 6, 6};
  s.offsets.assign(9, Vec3::Zero());
  EXPECT_EQ(toesOf(s, {1, 4, 6, 8}), (std::vector<int>{3, 5, 6, 8}));
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

PairCurve curveOfClips(const std::vector<Clip>& clips) {
  std::vector<Matrix> poses;
  for (const Clip& clip : clips) poses.push_back(rootFramePoses(clip));
  return pairCurve(poses);
}

TEST(Diversity, IsZeroForCopiesWhereverTheyWalk) {
  const Clip clip = walk(presetPath("slow", 3.0, 20.0), {.fps = 20.0}).clip;
  Clip moved = clip;
  for (Vec3& p : moved.positions) p = Vec3(p.z() + 3.0f, p.y(), -p.x());
  const PairCurve curve = curveOfClips({clip, moved});
  EXPECT_NEAR(curve.meanM(0, curve.pairs.size()), 0.0, 1e-4);
}

TEST(Diversity, OfARaisedCopyIsTheRiseAndSaysHowManyMotionsGoOn) {
  const Clip clip = walk(presetPath("slow", 3.0, 20.0), {.fps = 20.0}).clip;
  Clip raised = clip;
  for (Vec3& p : raised.positions) p.y() += 0.3f;
  const PairCurve curve = curveOfClips({clip, raised, sliceFrames(clip, 0, 20)});
  ASSERT_EQ(curve.pairs.size(), static_cast<size_t>(clip.frameCount()));
  // Pairs: 0.3, 0 and 0.3 for 20 frames, then 0.3 alone.
  EXPECT_EQ(curve.motions[19], 3);
  EXPECT_EQ(curve.motions[20], 2);
  EXPECT_NEAR(curve.meanM(5), 0.2, 1e-3);
  EXPECT_NEAR(curve.meanM(30), 0.3, 1e-4);
  const double rest = clip.frameCount() - 20.0;
  EXPECT_NEAR(curve.meanM(0, 1000), (20.0 * 0.6 + rest * 0.3) / (60.0 + rest), 1e-3);
  EXPECT_TRUE(std::isnan(curve.meanM(5, 5)));
}

TEST(Diversity, OfOneMotionIsNothing) {
  EXPECT_TRUE(pairCurve({Matrix::Zero(3, 6)}).pairs.empty());
}

TEST(Diversity, SpreadsTheClipsThatItKeeps) {
  EXPECT_EQ(spreadIndices(3, 10), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(spreadIndices(10, 5), (std::vector<int>{0, 2, 4, 6, 8}));
}

}  // namespace
}  // namespace marey::stats

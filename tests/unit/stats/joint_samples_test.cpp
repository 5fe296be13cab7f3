#include "stats/joint_samples.h"

#include <cmath>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"

namespace marey::stats {
namespace {

TEST(JointSamples, SpeedIsInCentimetresPerSecondInSpace) {
  // 3 and 4 cm along two axes in a tenth of a second.
  const Clip clip = pointClip({Vec3(0, 0, 0), Vec3(0.03f, 0.04f, 0), Vec3(0.03f, 0.04f, 0)}, 10.0);
  const auto samples = jointSamples(clip, Quantity::Speed);
  ASSERT_EQ(samples[0].size(), 2u);
  EXPECT_NEAR(samples[0][0], 50.0, 1e-4);
  EXPECT_EQ(samples[0][1], 0.0);
}

TEST(JointSamples, HeightIsTheTrueHeight) {
  const Clip clip = pointClip({Vec3(5, 0.25f, 7)}, 10.0);
  EXPECT_NEAR(jointSamples(clip, Quantity::Height)[0][0], 25.0, 1e-5);
}

TEST(JointSamples, TheAngleIsTheBendBetweenTheBones) {
  Clip clip;
  clip.skeleton = chainSkeleton(3);
  clip.fps = 20.0;
  const auto add = [&](const Vec3& end) {
    clip.positions.insert(clip.positions.end(), {Vec3(0, 0, 0), Vec3(0, 1, 0), end});
  };
  add(Vec3(0, 2, 0));
  add(Vec3(1, 1, 0));
  add(Vec3(0.5f, 1.0f + std::sqrt(0.75f), 0));
  const auto samples = jointSamples(clip, Quantity::Angle);
  EXPECT_TRUE(samples[0].empty());
  EXPECT_TRUE(samples[2].empty());
  ASSERT_EQ(samples[1].size(), 3u);
  EXPECT_NEAR(samples[1][0], 0.0, 1e-6);
  EXPECT_NEAR(samples[1][1], 90.0, 1e-6);
  EXPECT_NEAR(samples[1][2], 30.0, 1e-4);
}

TEST(JointSamples, PlacesAreInTheRootFrame) {
  // A walker that turns keeps its left hip about 9 cm to its left and at the root's depth.
  const Clip clip = walk(presetPath("turn-left", 4.0, 60.0), {.fps = 60.0}).clip;
  const int hip = clip.skeleton->find("LeftUpLeg");
  const auto side = jointSamples(clip, Quantity::Sideways)[hip];
  const auto ahead = jointSamples(clip, Quantity::Forward)[hip];
  for (size_t t = 60; t + 60 < side.size(); ++t) {
    EXPECT_NEAR(side[t], 9.0, 6.0);
    EXPECT_NEAR(ahead[t], 0.0, 8.0);
  }
}

TEST(JointSamples, OfManyClipsArePooled) {
  const Clip clip = pointClip({Vec3(0, 1, 0), Vec3(0, 2, 0)}, 10.0);
  const std::vector<double> expected = {100.0, 200.0, 100.0, 200.0};
  EXPECT_EQ(pooledSamples({clip, clip}, Quantity::Height, 0), expected);
  EXPECT_THROW(pooledSamples({clip}, Quantity::Angle, 0), InputError);
  EXPECT_THROW(pooledSamples({clip}, Quantity::Height, 1), InputError);
}

TEST(JointSamples, TheStrideKeepsEveryKthFrame) {
  const Clip clip =
      pointClip({Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(0, 3, 0), Vec3(0, 4, 0), Vec3(0, 5, 0)}, 10.0);
  const std::vector<double> expected = {100.0, 300.0, 500.0};
  EXPECT_EQ(jointSamples(clip, Quantity::Height, 2)[0], expected);
}

}  // namespace
}  // namespace marey::stats

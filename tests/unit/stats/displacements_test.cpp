// Feet that are put elsewhere, and feet that shake.
#include "stats/displacements.h"

#include <cmath>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/random.h"
#include "motion/path.h"
#include "motion/standing.h"
#include "motion/walker.h"
#include "stats/footsteps.h"

namespace marey::stats {
namespace {

/// Rests of so many frames at these places along x, with one frame between.
Clip restsAt(const std::vector<float>& places, int frames = 10) {
  std::vector<Vec3> positions;
  for (const float x : places) {
    if (!positions.empty()) positions.emplace_back((positions.back().x() + x) / 2, 0.1f, 0);
    for (int t = 0; t < frames; ++t) positions.emplace_back(x, 0, 0);
  }
  return pointClip(std::move(positions), 20.0);
}

TEST(Displacements, AreMovesOfMoreThanThreeCentimetresBetweenRests) {
  EXPECT_EQ(displacements(restsAt({0.0f}), 0), 0);
  EXPECT_EQ(displacements(restsAt({0.0f, 0.2f, 0.4f}), 0), 2);
  EXPECT_EQ(displacements(restsAt({0.0f, 0.029f}), 0), 0);
  EXPECT_EQ(displacements(restsAt({0.0f, 0.031f}), 0), 1);
}

TEST(Displacements, AFootThatIsLiftedAndPutBackIsNotDisplaced) {
  Clip clip = restsAt({0.0f, 0.0f});
  for (int t = 9; t < 12; ++t) clip.frame(t)[0] = Vec3(0.1f, 0.2f, 0);
  EXPECT_EQ(displacements(clip, 0), 0);
}

TEST(Displacements, JitterIsNoStepWhileRunsOfSlowFramesCountIt) {
  // Noise of 0.7 cm: hundreds of runs below a tolerance, no displacement.
  const RandomKey key{.seed = 5, .stage = RandomStage::Test};
  std::vector<Vec3> positions;
  for (uint32_t t = 0; t < 400; ++t)
    positions.emplace_back(static_cast<float>(0.007 * (uniformAt(key, 2 * t) - 0.5)), 0,
                           static_cast<float>(0.007 * (uniformAt(key, 2 * t + 1) - 0.5)));
  const Clip clip = pointClip(std::move(positions), 20.0);
  EXPECT_GT(footstepCurve({clip}, {.feet = {0}}).maxCount, 50.0);
  EXPECT_EQ(displacements(clip, 0), 0);
}

TEST(Displacements, OfAWalkerAreItsStepsButTheFirst) {
  const WalkerClip w = walk(presetPath("slow", 8.0, 60.0), {.seed = 3, .fps = 60.0});
  for (const int foot : feetOf(*w.clip.skeleton)) {
    // Contacts of the truth in which a foot rests: all are further apart than 3 cm.
    int known = 0;
    for (const Contact& c : w.truth.contacts)
      if (c.joint == foot && c.endS - c.beginS > 0.3) ++known;
    EXPECT_NEAR(displacements(w.clip, foot), known - 1, 1) << foot;
    EXPECT_GT(known, 4);
  }
}

TEST(Displacements, OnlyInsideTheFramesThatAreAskedFor) {
  const Clip clip = restsAt({0.0f, 0.2f, 0.4f});
  EXPECT_EQ(displacements(clip, 0, 0, 21), 1);
  EXPECT_EQ(displacements(clip, 0, 11, 21), 0);
}

TEST(Stands, AreWhereAPathNeitherMovesNorTurnsForASecond) {
  // 20 fps: 30 frames still, 20 at 1 m/s, 10 still (too short), 40 turning on the spot, 25 still.
  std::vector<RootFrame> path = {{0, 0, 0}};
  const auto go = [&](int frames, double step, double turn) {
    for (int t = 0; t < frames; ++t)
      path.push_back({path.back().x, path.back().z + step, path.back().heading + turn});
  };
  go(29, 0, 0);
  go(20, 0.05, 0);
  go(10, 0, 0);
  go(40, 0, 0.03);
  go(25, 0, 0);
  const auto stands = standsOf(path, 20.0);
  ASSERT_EQ(stands.size(), 2U);
  EXPECT_EQ(stands[0].first, 0);
  EXPECT_EQ(stands[0].last, 30);
  EXPECT_EQ(stands[1].first, 99);
  EXPECT_EQ(stands[1].last, 125);
  EXPECT_NEAR(standingSeconds(path, 20.0), (29 + 25) / 20.0, 1e-12);
  EXPECT_TRUE(standsOf({}, 20.0).empty());
}

}  // namespace
}  // namespace marey::stats

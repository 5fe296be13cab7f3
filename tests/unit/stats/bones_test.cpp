#include "stats/bones.h"

#include <cmath>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/walker.h"

namespace marey::stats {
namespace {

/// Two joints whose distance is that of `lengths`, frame by frame.
Clip boneClip(const std::vector<float>& lengths) {
  Clip clip;
  clip.name = "bone";
  clip.skeleton = chainSkeleton(2);
  clip.fps = 20.0;
  for (float length : lengths) {
    clip.positions.emplace_back(0, 0, 0);
    clip.positions.emplace_back(0, length, 0);
  }
  return clip;
}

TEST(Bones, TheErrorIsTheRootMeanSquareInCentimetres) {
  // Deviations from 1 m: 3 cm and -4 cm. sqrt((9 + 16) / 2) = 3.5355 cm.
  EXPECT_NEAR(boneLengthRmseCm({boneClip({1.03f, 0.96f})}, {1.0}), std::sqrt(12.5), 1e-4);
}

TEST(Bones, FramesOfAllClipsCountAlike) {
  // Deviations 3, 0, 0 and 3 cm: sqrt(18 / 4).
  EXPECT_NEAR(boneLengthRmseCm({boneClip({1.03f, 1.0f, 1.0f}), boneClip({0.97f})}, {1.0}),
              std::sqrt(4.5), 1e-4);
}

TEST(Bones, TheMeanLengthIsOverAllFramesOfAllClips) {
  const auto mean = meanBoneLengths({boneClip({1.0f, 2.0f}), boneClip({6.0f})});
  ASSERT_EQ(mean.size(), 1u);
  EXPECT_NEAR(mean[0], 3.0, 1e-6);
}

TEST(Bones, TheWalkerIsRigid) {
  for (const WalkerClip& w : walkerDataSet(6, 2.0, 3)) {
    EXPECT_LT(boneLengthRmseCm({w.clip}, skeletonBoneLengths(*w.clip.skeleton)), 1e-3);
    EXPECT_LT(boneLengthRmseCm({w.clip}, meanBoneLengths({w.clip})), 1e-3);
  }
}

TEST(Bones, ClipsOfOtherJointsAreRefused) {
  EXPECT_THROW(meanBoneLengths({boneClip({1.0f}), pointClip({Vec3(0, 0, 0)}, 20.0)}), InputError);
  EXPECT_THROW(meanBoneLengths({}), InputError);
  EXPECT_THROW(boneLengthRmseCm({boneClip({1.0f})}, {1.0, 1.0}), InputError);
}

}  // namespace
}  // namespace marey::stats

#include "task/pose_error.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

/// Two joints; the second moves away from the first by `step` metres a frame.
Clip moving(int frames, float step) {
  auto body = std::make_shared<Skeleton>();
  body->names = {"Hips", "Head"};
  body->parents = {-1, 0};
  body->offsets = {{0, 0, 0}, {0, 1, 0}};
  Clip out{.name = "moving", .skeleton = body, .fps = 20.0};
  for (int t = 0; t < frames; ++t) {
    out.positions.emplace_back(0, 0, 0);
    out.positions.emplace_back(0, 1.F + step * static_cast<float>(t), 0);
  }
  return out;
}

TEST(PoseError, IsTheMeanDistanceOfJoints) {
  const Clip still = moving(3, 0.F), slow = moving(3, 0.02F), fast = moving(5, 0.04F);
  // Of the second joint 0, 2, 4 cm and 0, 4, 8 cm; the first is where it should be.
  const PoseError one = poseError({&slow, 1}, still);
  EXPECT_NEAR(one.meanCm, 1.0, 1e-5);
  EXPECT_NEAR(one.bestCm, 1.0, 1e-5);
  ASSERT_EQ(one.byFrameCm.size(), 3U);
  EXPECT_NEAR(one.byFrameCm[2], 2.0, 1e-5);
  const std::vector<Clip> both{slow, fast};
  const PoseError two = poseError(both, still);
  EXPECT_NEAR(two.meanCm, 1.5, 1e-5);
  EXPECT_NEAR(two.bestCm, 1.0, 1e-5);
  EXPECT_NEAR(two.byFrameCm[1], 1.5, 1e-5);
}

TEST(PoseError, RefusesNoMotionAndOtherBodies) {
  const Clip still = moving(3, 0.F);
  EXPECT_THROW(poseError({}, still), InputError);
  Clip other = still;
  auto body = std::make_shared<Skeleton>(*still.skeleton);
  body->names.pop_back();
  body->parents.pop_back();
  body->offsets.pop_back();
  other.skeleton = body;
  EXPECT_THROW(poseError({&other, 1}, still), InputError);
}

}  // namespace
}  // namespace marey

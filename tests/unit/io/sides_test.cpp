// Left and right exchanged while reading.
#include "unit/io/support.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/clip_io.h"
#include "io/doctor.h"
#include "io/normalise.h"
#include "motion/kinematics.h"
#include "motion/roles.h"
#include "motion/walker.h"

namespace marey::io {
namespace {

TEST(SwappedSides, GiveEveryJointTheMotionOfTheOtherSide) {
  const test::TemporaryFolder folder;
  const auto file = folder / "walk.bvh";
  writeClip(walkerDataSet(1, 4.0, 3).front().clip, file);
  const Clip named = readClip(file);
  const Clip swapped = readClip(file, {.swapSides = true});
  const std::vector<int> mirror = rolesOf(*named.skeleton).mirror;
  EXPECT_EQ(swapped.skeleton->names, named.skeleton->names);
  EXPECT_EQ(swapped.skeleton->parents, named.skeleton->parents);
  for (int j = 0; j < named.jointCount(); ++j)
    EXPECT_EQ(swapped.at(5, j), named.at(5, mirror[static_cast<size_t>(j)]));
  const auto again = forwardKinematics(*swapped.skeleton, *swapped.transforms);
  for (size_t i = 0; i < again.size(); ++i)
    EXPECT_LT((again[i] - swapped.positions[i]).norm(), 1e-4F);
  EXPECT_EQ(examineClip(named).sides.value, "as named");
  EXPECT_EQ(examineClip(swapped).sides.value, "swapped");
}

TEST(SwappedSides, TwiceAreTheFirstOnes) {
  const Clip clip = walkerDataSet(1, 1.0, 3).front().clip;
  Clip twice = clip;
  swapSides(twice);
  EXPECT_NE(twice.positions, clip.positions);
  swapSides(twice);
  EXPECT_EQ(twice.positions, clip.positions);
  EXPECT_EQ(*twice.skeleton, *clip.skeleton);
}

TEST(SwappedSides, NeedJointsThatHaveSides) {
  auto body = std::make_shared<Skeleton>();
  body->names = {"Root", "Tip"};
  body->parents = {-1, 0};
  body->offsets.assign(2, Vec3::Zero());
  Clip clip{.name = "stick", .skeleton = body, .fps = 20.0, .positions = {{0, 0, 0}, {0, 1, 0}}};
  EXPECT_THROW(swapSides(clip), InputError);
}

}  // namespace
}  // namespace marey::io

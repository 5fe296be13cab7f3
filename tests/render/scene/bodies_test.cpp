#include "render/scene/bodies.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/scene/contacts.h"
#include "render/scene/tracks.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

TEST(Bodies, LeftLimbsAreLighterThanRightOnes) {
  const Clip clip = tinyClip(1);
  const BodyShape shape = bodyShape(*clip.skeleton, clip.frame(0));
  ASSERT_EQ(shape.capsules.size(), 7U);
  for (const Capsule& c : shape.capsules) {
    const std::string& name = clip.skeleton->names[static_cast<size_t>(c.to)];
    EXPECT_EQ(c.leftSide, name.starts_with("Left")) << name;
  }
  EXPECT_EQ(shape.head, clip.skeleton->find("Head"));
}

TEST(Bodies, ALoneJointIsABall) {
  Skeleton skeleton;
  skeleton.names = {"Root"};
  skeleton.parents = {-1};
  skeleton.offsets = {Vec3::Zero()};
  const std::vector<Vec3> pose = {{0, 1, 0}};
  const BodyShape shape = bodyShape(skeleton, pose);
  ASSERT_EQ(shape.capsules.size(), 1U);
  EXPECT_EQ(shape.capsules[0].from, shape.capsules[0].to);
  EXPECT_GT(shape.capsules[0].radiusFrom, 0.0F);
}

TEST(Bodies, PosesAreLinearInTimeAndHeldBeyondTheEnds) {
  const Track track(std::make_shared<const Clip>(tinyClip(5)));  // 1 m/s along x at 10 fps
  const auto rootX = [&](double at) { return track.joint(at, 0, Placement::World).x(); };
  EXPECT_NEAR(rootX(0.25), 0.25F, 1e-6F);
  EXPECT_NEAR(rootX(0.4), 0.4F, 1e-6F);
  EXPECT_NEAR(rootX(-1.0), 0.0F, 1e-6F);
  EXPECT_NEAR(rootX(9.0), 0.4F, 1e-6F);
}

TEST(Contacts, AFootAtRestIsFoundWithItsPlaceAndTime) {
  const std::vector<Rest> rests = feetAtRest(tinyClipWithRest(20, 6, 12), {});
  ASSERT_EQ(rests.size(), 1U);
  EXPECT_EQ(rests[0].joint, tinySkeleton()->find("LeftFoot"));
  EXPECT_NEAR(rests[0].beginS, 0.6, 1e-9);
  EXPECT_NEAR(rests[0].endS, 1.2, 1e-9);
  EXPECT_LT((rests[0].place - Vec3(0.6F, 0.05F, 0.1F)).norm(), 1e-5F);
}

TEST(Contacts, AreThoseOfAGaitDiagramByTheSameRule) {
  const Clip clip = tinyClipWithRest(20, 6, 12);
  // Everything glides at 1 m/s, so that a tolerance above it makes one contact of all frames.
  const std::vector<Rest> all = feetAtRest(clip, {.toleranceCmS = 130.0, .feet = "RightFoot"});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].joint, tinySkeleton()->find("RightFoot"));
  EXPECT_NEAR(all[0].beginS, 0.0, 1e-9);
  EXPECT_NEAR(all[0].endS, 1.9, 1e-9);
  EXPECT_TRUE(feetAtRest(clip, {.feet = "Hoof"}).empty()) << "no such feet, no marks";
}

TEST(Contacts, AGlidingFigureHasNone) {
  EXPECT_TRUE(feetAtRest(tinyClip(20), {}).empty());
}

TEST(Contacts, ARestUntilTheLastFrameCounts) {
  const std::vector<Rest> rests = feetAtRest(tinyClipWithRest(10, 5, 9), {});
  ASSERT_EQ(rests.size(), 1U);
  EXPECT_NEAR(rests[0].endS, 0.9, 1e-9);
}

}  // namespace
}  // namespace marey::render

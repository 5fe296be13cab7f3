#include "render/scene/bodies.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/scene/contacts.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

/// Volume by the divergence theorem: positive when triangles wind outwards.
double volume(const Mesh& mesh) {
  const auto point = [&](uint32_t i) {
    return Eigen::Vector3d(mesh.positions[3 * i], mesh.positions[3 * i + 1],
                           mesh.positions[3 * i + 2]);
  };
  double sum = 0.0;
  for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto a = point(mesh.triangles[t]), b = point(mesh.triangles[t + 1]),
               c = point(mesh.triangles[t + 2]);
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

TEST(Bodies, ACapsuleHasItsVolumeAndPointsOutwards) {
  BodyShape shape;
  shape.capsules = {{0, 1, 0.1F, 0.1F, false}};
  const std::vector<Vec3> pose = {{0.3F, 1, -2}, {0.8F, 1.5F, -1}};
  Mesh mesh;
  appendPose(mesh, shape, pose, {1, 0, 0, 1}, {64, 24});
  const double length = (pose[1] - pose[0]).norm();
  const double exact = M_PI * 0.01 * length + 4.0 / 3.0 * M_PI * 0.001;
  EXPECT_NEAR(volume(mesh), exact, 0.01 * exact);
}

TEST(Bodies, EveryVertexLiesOnTheSkinWithItsNormalAcross) {
  BodyShape shape;
  shape.capsules = {{0, 1, 0.2F, 0.2F, false}};
  const std::vector<Vec3> pose = {{0, 0, 0}, {0, 1, 0}};
  Mesh mesh;
  appendPose(mesh, shape, pose, {1, 0, 0, 1});
  for (size_t v = 0; v < mesh.positions.size(); v += 3) {
    const Vec3 p(mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]);
    const Vec3 n(mesh.normals[v], mesh.normals[v + 1], mesh.normals[v + 2]);
    const Vec3 onAxis(0, std::clamp(p.y(), 0.0F, 1.0F), 0);
    EXPECT_NEAR((p - onAxis).norm(), 0.2F, 1e-5F);
    EXPECT_LT((onAxis + 0.2F * n - p).norm(), 1e-5F);
  }
}

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
  Mesh mesh;
  appendPose(mesh, bodyShape(skeleton, pose), pose, {0, 0, 0, 1});
  EXPECT_GT(volume(mesh), 0.0);
  for (const float v : mesh.positions) EXPECT_TRUE(std::isfinite(v));
}

TEST(Bodies, PosesAreLinearInTimeAndHeldBeyondTheEnds) {
  const Clip clip = tinyClip(5);  // 1 m/s along x at 10 fps
  EXPECT_NEAR(poseAt(clip, 0.25).front().x(), 0.25F, 1e-6F);
  EXPECT_NEAR(poseAt(clip, 0.4).front().x(), 0.4F, 1e-6F);
  EXPECT_NEAR(poseAt(clip, -1.0).front().x(), 0.0F, 1e-6F);
  EXPECT_NEAR(poseAt(clip, 9.0).front().x(), 0.4F, 1e-6F);
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

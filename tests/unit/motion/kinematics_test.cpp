#include "motion/kinematics.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// root - arm (1 up) - hand (2 up), with a tip 0.5 above the hand.
Skeleton threeJoints() {
  Skeleton s;
  s.names = {"root", "arm", "hand"};
  s.parents = {-1, 0, 1};
  s.offsets = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 2, 0)};
  s.endSites = {{2, Vec3(0, 0.5f, 0)}};
  return s;
}

Quat aboutZ(float angle) {
  return Quat(Eigen::AngleAxisf(angle, Vec3::UnitZ()));
}

JointTransforms bentPose() {
  return {{aboutZ(kPi / 2), aboutZ(-kPi / 2), aboutZ(kPi / 6)},
          {Vec3(10, 0, 5), Vec3(0, 1, 0), Vec3(0, 2, 0)}};
}

TEST(Kinematics, PositionsOfABentChainEqualPlaneGeometry) {
  const std::vector<Vec3> p = forwardKinematics(threeJoints(), bentPose());
  // A quarter turn lays the first bone along -x; the next one turns back and stands up.
  EXPECT_LT((p[0] - Vec3(10, 0, 5)).norm(), 1e-6f);
  EXPECT_LT((p[1] - Vec3(9, 0, 5)).norm(), 1e-6f);
  EXPECT_LT((p[2] - Vec3(9, 2, 5)).norm(), 1e-6f);
}

TEST(Kinematics, WorldRotationsAddUpAlongTheChain) {
  const std::vector<Quat> q = globalRotations(threeJoints(), bentPose());
  EXPECT_LT(q[0].angularDistance(aboutZ(kPi / 2)), 1e-6f);
  EXPECT_LT(q[1].angularDistance(Quat::Identity()), 1e-3f);
  EXPECT_LT(q[2].angularDistance(aboutZ(kPi / 6)), 1e-6f);
}

TEST(Kinematics, FramesAreSolvedIndependently) {
  JointTransforms two = bentPose();
  const JointTransforms one = bentPose();
  two.rotations.insert(two.rotations.end(), {Quat::Identity(), Quat::Identity(), Quat::Identity()});
  two.translations.insert(two.translations.end(), one.translations.begin(), one.translations.end());
  const std::vector<Vec3> p = forwardKinematics(threeJoints(), two);
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(p[5], Vec3(10, 3, 5));
}

TEST(Kinematics, RestPoseAndBoneLengthsComeFromOffsets) {
  EXPECT_EQ(restPositions(threeJoints())[2], Vec3(0, 3, 0));
  EXPECT_EQ(boneLengths(threeJoints()), (std::vector<float>{1.0f, 2.0f}));
}

TEST(Kinematics, TransformsOfAnotherSizeAreRefused) {
  JointTransforms bad = bentPose();
  bad.translations.pop_back();
  EXPECT_THROW(forwardKinematics(threeJoints(), bad), InputError);
  bad.rotations.pop_back();
  EXPECT_THROW(globalRotations(threeJoints(), bad), InputError);
}

}  // namespace
}  // namespace marey

// The exponential maps of joint-expmap against Eigen's rotations, and what only it promises.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "motion/kinematics.h"
#include "motion/representation/mirror_plan.h"
#include "motion/representation/representation.h"
#include "motion/roles.h"
#include "motion/walker.h"

namespace marey {
namespace {

constexpr double kFps = 20.0;
constexpr double kPi = std::numbers::pi;
const FeatureSpec kSpec{.layout = "joint-expmap", .fps = kFps};

const Representation& expmap() {
  return representationNamed("joint-expmap", {});
}

/// The walker's body, one joint of which has the given local rotation in every frame.
Clip turning(int joint, const std::vector<Quatd>& rotations) {
  Clip out{.name = "turning", .skeleton = walkerSkeleton(), .fps = kFps};
  JointTransforms local;
  for (const Quatd& q : rotations)
    for (int j = 0; j < out.skeleton->jointCount(); ++j) {
      local.rotations.push_back(j == joint ? q.cast<float>() : Quat::Identity());
      local.translations.push_back(out.skeleton->offsets[static_cast<size_t>(j)]);
    }
  out.positions = forwardKinematics(*out.skeleton, local);
  out.transforms = std::move(local);
  return out;
}

int elbow() {
  return walkerSkeleton()->find("LeftForeArm");
}

long columnOf(const std::string& name) {
  const auto channels = expmap().channels(*walkerSkeleton());
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == name) return static_cast<long>(i);
  return -1;
}

Eigen::Vector3f elbowValues(const FeatureSequence& f, long t) {
  return f.pose.row(t).segment<3>(columnOf("LeftForeArm.rx")).transpose();
}

TEST(JointExpmap, IsAxisTimesAngleOfTheLocalRotation) {
  const Vec3d axis = Vec3d(0.2, -0.5, 0.9).normalized();
  std::vector<Quatd> rotations;
  for (int t = 0; t < 20; ++t) rotations.emplace_back(Eigen::AngleAxisd(0.1 * t, axis));
  const auto f = extractFeatures(turning(elbow(), rotations), kSpec);
  for (int t = 0; t < 20; ++t)
    EXPECT_LT((elbowValues(f, t).cast<double>() - 0.1 * t * axis).norm(), 1e-6) << t;
}

TEST(JointExpmap, HasTheRootAsPlaceAndTurnInItsFrame) {
  // The body stands at (2, 0.975, 3), looks 1 rad to the left and leans 0.2 rad forward.
  Clip clip = turning(0, {axisRotation(1, 1.0) * axisRotation(0, 0.2)});
  for (Vec3& p : clip.positions) p += Vec3(2.f, 0.f, 3.f);
  clip.transforms->translations[0] += Vec3(2.f, 0.f, 3.f);
  const auto f = extractFeatures(clip, kSpec);
  ASSERT_NEAR(f.start.heading, 1.0, 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.x")), 0.0, 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.y")), walkerSkeleton()->offsets[0].y(), 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.z")), 0.0, 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.rx")), 0.2, 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.ry")), 0.0, 1e-6);
  EXPECT_NEAR(f.pose(0, columnOf("Hips.rz")), 0.0, 1e-6);
}

TEST(JointExpmap, GoesOnPastHalfAndWholeTurns) {
  const Vec3d axis = Vec3d(0.6, 0.0, -0.8);
  std::vector<Quatd> rotations;
  for (int t = 0; t <= 100; ++t) rotations.emplace_back(Eigen::AngleAxisd(0.15 * t, axis));
  const Clip clip = turning(elbow(), rotations);
  const auto f = extractFeatures(clip, kSpec);
  for (int t = 0; t <= 100; ++t)  // to 15 rad: more than two turns
    ASSERT_LT((elbowValues(f, t).cast<double>() - 0.15 * t * axis).norm(), 5e-6) << t;
  const Clip back = rebuildMotion(f.pose, f.control, f.start, clip.skeleton, kSpec);
  for (size_t i = 0; i < clip.positions.size(); ++i)
    ASSERT_LT((back.positions[i] - clip.positions[i]).norm(), 5e-5f);
}

TEST(JointExpmap, IsRelativeToTheRestPose) {
  Skeleton rested = *walkerSkeleton();
  rested.rest.assign(static_cast<size_t>(rested.jointCount()), Eigen::Quaternionf::Identity());
  const Quatd rest(Eigen::AngleAxisd(2.0, Vec3d::UnitZ())),
      turn(Eigen::AngleAxisd(0.3, Vec3d::UnitX()));
  rested.rest[static_cast<size_t>(elbow())] = rest.cast<float>();
  const auto f = extractFeatures(turning(elbow(), {rest * turn}), kSpec,
                                 std::make_shared<const Skeleton>(rested));
  EXPECT_LT((elbowValues(f, 0).cast<double>() - Vec3d(0.3, 0.0, 0.0)).norm(), 1e-6);
}

TEST(JointExpmap, TakesTheMeanPoseOfTheClipsAsRestPose) {
  // Half the frames at 1 rad, half at 2 rad: the mean rotation is at 1.5 rad.
  std::vector<Quatd> rotations;
  for (int t = 0; t < 10; ++t) rotations.push_back(axisRotation(2, t < 5 ? 1.0 : 2.0));
  const auto skeleton = expmap().skeletonOf({turning(elbow(), rotations)}, kSpec);
  ASSERT_EQ(skeleton->rest.size(), static_cast<size_t>(skeleton->jointCount()));
  EXPECT_LT(angleBetween(skeleton->rest[static_cast<size_t>(elbow())].cast<double>(),
                         axisRotation(2, 1.5)),
            1e-6);
}

TEST(JointExpmap, MirroredOnASymmetricRestPoseIsAnAxialVectorMirroredAtX) {
  const auto mirror = rolesOf(*walkerSkeleton()).mirror;
  std::vector<Quatd> local;
  for (int j = 0; j < walkerSkeleton()->jointCount(); ++j)
    local.push_back(expMap(Vec3d(0.1 * j, 0.5 - 0.05 * j, 0.3)));
  const auto other = MirrorPlan(*walkerSkeleton()).mirrored(local);
  for (size_t j = 0; j < local.size(); ++j) {
    const Vec3d v = logMap(local[static_cast<size_t>(mirror[j])]);
    // The walker's offsets are symmetric to a float; corrections are of their size.
    EXPECT_LT((logMap(other[j]) - Vec3d(v.x(), -v.y(), -v.z())).norm(), 1e-5) << j;
  }
}

TEST(JointExpmap, BonesAreTheSkeletonsWhateverTheValues) {
  const auto skeleton = walkerSkeleton();
  const Matrix pose = 2.f * Matrix::Random(30, expmap().width(*skeleton));
  const Clip clip = rebuildMotion(pose, Matrix::Zero(30, 3), {}, skeleton, kSpec);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (const auto& [parent, child] : skeleton->bones())
      ASSERT_NEAR((clip.at(t, child) - clip.at(t, parent)).norm(),
                  skeleton->offsets[static_cast<size_t>(child)].norm(), 2e-6);
}

TEST(JointExpmap, ClipsOfLongerBonesKeepTheirRotations) {
  const Clip clip = turning(elbow(), std::vector<Quatd>(4, axisRotation(2, 0.7)));
  auto longer = std::make_shared<Skeleton>(*walkerSkeleton());
  for (auto& offset : longer->offsets) offset *= 1.2f;
  const auto own = extractFeatures(clip, kSpec), other = extractFeatures(clip, kSpec, longer);
  EXPECT_EQ(other.pose, own.pose);
  EXPECT_EQ(other.fitM, 0.0);
}

TEST(JointExpmap, ClipsOfOtherAxesAreFittedToTheRestPose) {
  // The same motion about joints whose axes are turned: positions decide.
  const Clip clip = turning(elbow(), std::vector<Quatd>(4, axisRotation(1, 0.7)));
  Clip other = clip;
  auto turned = std::make_shared<Skeleton>(*clip.skeleton);
  for (size_t j = 1; j < turned->offsets.size(); ++j)
    turned->offsets[j] = axisRotation(0, 0.4).cast<float>() * turned->offsets[j];
  other.skeleton = turned;
  const auto f = extractFeatures(other, kSpec, clip.skeleton);
  const Clip back = rebuildMotion(f.pose, f.control, f.start, clip.skeleton, kSpec);
  EXPECT_GT(f.fitM, 0.0);
  for (size_t i = 0; i < clip.positions.size(); ++i)
    EXPECT_LT((back.positions[i] - clip.positions[i]).norm(), f.fitM + 1e-5);
}

}  // namespace
}  // namespace marey

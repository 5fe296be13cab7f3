#include "motion/features.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/walker.h"

namespace marey {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFps = 20.0;
const FeatureSpec kUnfiltered{.fps = kFps, .rootSigmaS = 0.0, .facingSigmaS = 0.0};

Clip turningWalk(int frames = 121) {
  std::vector<RootFrame> path;
  for (int t = 0; t < frames; ++t) {
    const double angle = 0.6 * t / kFps;  // a circle of 1.5 m at 0.9 m/s, turning left
    path.push_back({1.0 - 1.5 * std::cos(angle), 2.0 + 1.5 * std::sin(angle), angle});
  }
  return walk(path, {.seed = 5, .fps = kFps}).clip;
}

/// Hip and shoulder joints of a body; all its other joints lie in the hips.
struct Stance {
  Vec3 hips;
  double hipHeading = 0.0, shoulderHeading = 0.0;
};

Vec3 leftOf(double heading) {
  return {static_cast<float>(std::cos(heading)), 0.f, static_cast<float>(-std::sin(heading))};
}

Clip bodyClip(int frames, const std::function<Stance(int)>& stanceAt) {
  Clip clip{.name = "body", .skeleton = walkerSkeleton(), .fps = kFps};
  const Skeleton& s = *clip.skeleton;
  clip.positions.resize(static_cast<size_t>(frames * s.jointCount()));
  for (int t = 0; t < frames; ++t) {
    const Stance stance = stanceAt(t);
    const auto joints = clip.frame(t);
    std::fill(joints.begin(), joints.end(), stance.hips);
    joints[s.find("LeftUpLeg")] += 0.1f * leftOf(stance.hipHeading);
    joints[s.find("RightUpLeg")] -= 0.1f * leftOf(stance.hipHeading);
    joints[s.find("LeftArm")] += 0.1f * leftOf(stance.shoulderHeading);
    joints[s.find("RightArm")] -= 0.1f * leftOf(stance.shoulderHeading);
  }
  return clip;
}

Vec3 at(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

Clip rebuilt(const FeatureSequence& features) {
  return rebuildMotion(features.pose, features.control, features.start, walkerSkeleton(),
                       {.fps = kFps});
}

TEST(Features, RebuildingATurningWalkGivesItsWorldMotion) {
  const Clip clip = turningWalk();
  const Clip back = rebuilt(extractFeatures(clip, {}));
  ASSERT_EQ(back.frameCount(), clip.frameCount());
  float worst = 0.f;
  for (size_t i = 0; i < clip.positions.size(); ++i)
    worst = std::max(worst, (clip.positions[i] - back.positions[i]).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 1e-4f);
}

TEST(Features, ForwardIsThirdAxisAndLeftIsFirstAxis) {
  const auto forwards =
      extractFeatures(bodyClip(9, [](int t) { return Stance{at(0, 1, 0.05 * t)}; }), kUnfiltered);
  const auto leftwards =
      extractFeatures(bodyClip(9, [](int t) { return Stance{at(0.03 * t, 1, 0)}; }), kUnfiltered);
  for (long t = 0; t < 9; ++t) {
    EXPECT_NEAR(forwards.control(t, 0), 0.0, 1e-6);
    EXPECT_NEAR(forwards.control(t, 1), 0.05, 1e-6);
    EXPECT_NEAR(leftwards.control(t, 0), 0.03, 1e-6);
    EXPECT_NEAR(leftwards.control(t, 1), 0.0, 1e-6);
    EXPECT_NEAR(leftwards.control(t, 2), 0.0, 1e-6);
  }
}

TEST(Features, ControlIsSeenFromTheBodyAndNotFromTheWorld) {
  // Facing +X, the body walks along +X (forwards) and drifts along -Z, which is its left.
  const auto f =
      extractFeatures(bodyClip(5,
                               [](int t) {
                                 return Stance{at(0.05 * t, 1, -0.02 * t), kPi / 2, kPi / 2};
                               }),
                      kUnfiltered);
  EXPECT_NEAR(f.start.heading, kPi / 2, 1e-6);
  for (long t = 0; t < 5; ++t) {
    EXPECT_NEAR(f.control(t, 0), 0.02, 1e-6);
    EXPECT_NEAR(f.control(t, 1), 0.05, 1e-6);
  }
}

TEST(Features, TurningLeftIsAPositiveTurnAndContinuesAcrossHalfATurn) {
  const auto f = extractFeatures(
      bodyClip(60,
               [](int t) {
                 return Stance{at(0, 1, 0), 0.1 * t, 0.1 * t};  // from +Z towards +X
               }),
      kUnfiltered);
  for (long t = 0; t < 60; ++t) EXPECT_NEAR(f.control(t, 2), 0.1, 1e-5) << t;
}

TEST(Features, PosesAreSeenFromTheRootFrameWithTheirTrueHeight) {
  const auto f = extractFeatures(bodyClip(3,
                                          [](int) {
                                            return Stance{at(4, 0.9, -7), 1.1, 1.1};
                                          }),
                                 kUnfiltered);
  const int left = 3 * walkerSkeleton()->find("LeftUpLeg");
  EXPECT_NEAR(f.pose(1, left), 0.1, 1e-5);
  EXPECT_NEAR(f.pose(1, left + 1), 0.9, 1e-6);
  EXPECT_NEAR(f.pose(1, left + 2), 0.0, 1e-5);
}

TEST(Features, FacingIsTheMeanOfHipsAndShoulders) {
  const auto frames = rootTrajectory(bodyClip(3,
                                              [](int) {
                                                return Stance{at(0, 1, 0), 0.2, 1.0};
                                              }),
                                     kUnfiltered);
  // Two vectors of equal length: their sum halves the angle.
  for (const RootFrame& frame : frames) EXPECT_NEAR(frame.heading, 0.6, 1e-5);
}

TEST(Features, ASteadyWalkStaysSteadyUnderTheFilterUpToItsEnds) {
  const auto f = extractFeatures(bodyClip(40,
                                          [](int t) {
                                            return Stance{at(0, 1, 0.05 * t), 0.01 * t, 0.01 * t};
                                          }),
                                 {});
  for (long t = 1; t < 40; ++t) {
    EXPECT_NEAR(std::hypot(f.control(t, 0), f.control(t, 1)), 0.05, 1e-5) << t;
    EXPECT_NEAR(f.control(t, 2), 0.01, 1e-5) << t;
  }
}

TEST(Features, AClipOfOneFrameHasNoMotionAndIsRebuilt) {
  const Clip clip = turningWalk(1);
  const auto f = extractFeatures(clip, {});
  ASSERT_EQ(f.frameCount(), 1);
  EXPECT_EQ(f.control, Matrix::Zero(1, 3));
  const Clip back = rebuilt(f);
  for (size_t i = 0; i < clip.positions.size(); ++i)
    EXPECT_LT((clip.positions[i] - back.positions[i]).norm(), 1e-5f);
}

TEST(Features, TheFirstControlRowRepeatsTheSecond) {
  const auto f = extractFeatures(turningWalk(), {});
  EXPECT_EQ(Matrix(f.control.row(0)), Matrix(f.control.row(1)));
}

TEST(Features, MirroringTwiceChangesNothing) {
  const auto f = extractFeatures(turningWalk(), {});
  const auto twice = mirrored(mirrored(f, {}, *walkerSkeleton()), {}, *walkerSkeleton());
  EXPECT_EQ(twice.pose, f.pose);
  EXPECT_EQ(twice.control, f.control);
  EXPECT_EQ(twice.start.x, f.start.x);
  EXPECT_EQ(twice.start.heading, f.start.heading);
}

TEST(Features, AMirroredWalkIsTheWorldMirroredWithLeftAndRightSwapped) {
  const Skeleton& s = *walkerSkeleton();
  const auto mirror = rolesOf(s).mirror;
  ASSERT_EQ(mirror[static_cast<size_t>(s.find("LeftFoot"))], s.find("RightFoot"));
  const auto f = extractFeatures(turningWalk(), {});
  const auto m = mirrored(f, {}, s);
  EXPECT_EQ(Matrix(m.control.col(0)), Matrix(-f.control.col(0)));
  EXPECT_EQ(Matrix(m.control.col(1)), Matrix(f.control.col(1)));
  EXPECT_EQ(Matrix(m.control.col(2)), Matrix(-f.control.col(2)));
  const Clip plain = rebuilt(f), other = rebuilt(m);
  for (int t = 0; t < plain.frameCount(); ++t)
    for (int j = 0; j < s.jointCount(); ++j) {
      const Vec3 p = plain.at(t, mirror[static_cast<size_t>(j)]);
      ASSERT_LT((other.at(t, j) - Vec3(-p.x(), p.y(), p.z())).norm(), 1e-5f) << t << " " << j;
    }
}

TEST(Features, AReversedWalkIsTheSameWorldMotionBackwards) {
  const auto f = extractFeatures(turningWalk(), {});
  const Clip plain = rebuilt(f), back = rebuilt(timeReversed(f, {}));
  const int n = plain.frameCount();
  for (int t = 0; t < n; ++t)
    for (int j = 0; j < plain.jointCount(); ++j)
      ASSERT_LT((back.at(t, j) - plain.at(n - 1 - t, j)).norm(), 1e-4f) << t << " " << j;
}

TEST(Features, AReversedForwardWalkHasBackwardControl) {
  const auto f = timeReversed(
      extractFeatures(bodyClip(9, [](int t) { return Stance{at(0, 1, 0.05 * t)}; }), kUnfiltered),
      {});
  for (long t = 0; t < 9; ++t) EXPECT_NEAR(f.control(t, 1), -0.05, 1e-6);
}

TEST(Features, ASkeletonWithoutHipJointsHasNoFacing) {
  auto skeleton = std::make_shared<Skeleton>();
  skeleton->names = {"a", "b"};
  skeleton->parents = {-1, 0};
  skeleton->offsets.resize(2, Vec3::Zero());
  const Clip clip{
      .name = "two", .skeleton = skeleton, .fps = kFps, .positions = {Vec3::Zero(), Vec3::UnitY()}};
  EXPECT_THROW(extractFeatures(clip, {}), InputError);
}

TEST(Features, PosesOfAnotherWidthAreRefused) {
  EXPECT_THROW(
      rebuildMotion(Matrix::Zero(4, 60), Matrix::Zero(4, 3), {}, walkerSkeleton(), {.fps = kFps}),
      InputError);
  EXPECT_THROW(
      rebuildMotion(Matrix::Zero(4, 63), Matrix::Zero(5, 3), {}, walkerSkeleton(), {.fps = kFps}),
      InputError);
}

}  // namespace
}  // namespace marey

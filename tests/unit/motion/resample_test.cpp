#include "motion/resample.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/kinematics.h"
#include "motion/rotation.h"

namespace marey {
namespace {

/// One joint at x = time (seconds) that turns 1 rad/s about Y.
Clip steadyClip(int frames, double fps) {
  Skeleton s;
  s.names = {"root"};
  s.parents = {-1};
  s.offsets = {Vec3::Zero()};
  Clip clip;
  clip.name = "steady";
  clip.skeleton = std::make_shared<const Skeleton>(s);
  clip.fps = fps;
  clip.transforms.emplace();
  for (int t = 0; t < frames; ++t) {
    const auto time = static_cast<float>(t / fps);
    clip.positions.emplace_back(time, 1.0f, 0.0f);
    clip.transforms->translations.push_back(clip.positions.back());
    clip.transforms->rotations.emplace_back(Eigen::AngleAxisf(time, Vec3::UnitY()));
  }
  return clip;
}

TEST(Resample, FrameKIsAtTimeKOverTheNewRate) {
  for (const double fps : {20.0, 24.0, 29.97, 30.0, 60.0, 240.0}) {
    const Clip out = resampled(steadyClip(121, 120.0), fps);
    for (int k = 0; k < out.frameCount(); ++k) {
      EXPECT_NEAR(out.at(k, 0).x(), k / fps, 1e-6) << fps;
      EXPECT_NEAR(
          out.transforms->rotations[static_cast<size_t>(k)].angularDistance(Quat::Identity()),
          k / fps, 1e-3)
          << fps;
    }
  }
}

TEST(Resample, TheLastFrameIsAtOrJustBeforeTheEnd) {
  EXPECT_EQ(resampled(steadyClip(121, 120.0), 20.0).frameCount(), 21);  // exactly 1 s
  EXPECT_EQ(resampled(steadyClip(120, 120.0), 20.0).frameCount(), 20);  // 119/120 s
  EXPECT_EQ(resampled(steadyClip(91, 30.0), 20.0).frameCount(), 61);    // exactly 3 s
  EXPECT_EQ(resampled(steadyClip(1, 30.0), 20.0).frameCount(), 1);
}

TEST(Resample, EveryThirdFrameIsTakenOverBitForBit) {
  const Clip in = steadyClip(60, 60.0);
  const Clip out = resampled(in, 20.0);
  for (int k = 0; k < out.frameCount(); ++k) EXPECT_EQ(out.at(k, 0), in.at(3 * k, 0));
}

TEST(Resample, TheSameRateGivesTheSameClip) {
  const Clip in = steadyClip(7, 30.0);
  EXPECT_EQ(resampled(in, 30.0).positions, in.positions);
}

TEST(Resample, RotationsTakeTheShortWayWhateverTheSignOfTheQuaternion) {
  Clip clip = steadyClip(3, 2.0);
  clip.transforms->rotations[1].coeffs() *= -1.0f;
  const Clip out = resampled(clip, 4.0);
  EXPECT_NEAR(out.transforms->rotations[1].angularDistance(Quat::Identity()), 0.25f, 1e-3f);
}

Vec3 at3(double x, double y, double z) {
  return Vec3d(x, y, z).cast<float>();
}

/// A body of two limbs at 30 fps whose joints all turn and whose root moves by formulas: what the
/// program that gave the expected numbers has as well.
Clip turningClip(int frames = 5) {
  Skeleton s;
  s.names = {"root", "a", "b", "c"};
  s.parents = {-1, 0, 1, 0};
  s.offsets = {Vec3::Zero(), at3(0.1, 0.4, 0.0), at3(0.0, 0.3, 0.05), at3(-0.2, 0.0, 0.1)};
  Clip clip;
  clip.name = "turning";
  clip.skeleton = std::make_shared<const Skeleton>(s);
  clip.fps = 30.0;
  clip.transforms.emplace();
  for (int t = 0; t < frames; ++t) {
    const std::array<Vec3d, 4> turns = {Vec3d(0.3 * t, 0.2 * std::sin(t), -0.1 * t),
                                        Vec3d(0.5 * std::cos(t), 0.1 * t, 0.4 * std::sin(2.0 * t)),
                                        Vec3d(0.2 * t, -0.3 * t, 0.25 * std::cos(t)),
                                        Vec3d::Zero()};
    for (size_t j = 0; j < 4; ++j) {
      clip.transforms->rotations.push_back(expMap(turns[j]).cast<float>());
      clip.transforms->translations.push_back(
          j > 0 ? s.offsets[j]
                : at3(0.1 * t * t, 1.0 + 0.05 * std::sin(t), 0.3 * std::cos(0.5 * t)));
    }
  }
  clip.positions = forwardKinematics(s, *clip.transforms);
  return clip;
}

Clip withoutTransforms(Clip clip) {
  clip.transforms.reset();
  return clip;
}

// Expected: scipy's Slerp and CubicHermiteSpline (tangents as the header has them) and rotation
// matrices, in double precision; ours is float.
TEST(Resample, BetweenFramesJointsTurnBySlerpAndTheRootGoesByACubic) {
  const std::array<std::array<Vec3, 4>, 2> expected = {{
      {at3(0.225, 1.0487994, 0.2191917), at3(0.3953182, 1.3942479, 0.366355),
       at3(0.4569, 1.633376, 0.543909), at3(0.0437123, 1.0254174, 0.3479864)},
      {at3(0.9, 1.007056, 0.0212212), at3(1.1032794, 1.2156517, 0.3130521),
       at3(1.2146771, 1.4553551, 0.4634942), at3(0.698319, 0.9786138, 0.1135024)},
  }};
  const Clip out = resampled(turningClip(), 20.0);  // frames 0, 1.5 and 3
  ASSERT_EQ(out.frameCount(), 3);
  for (int k = 1; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      EXPECT_LT(
          (out.at(k, j) - expected[static_cast<size_t>(k - 1)][static_cast<size_t>(j)]).norm(),
          2e-6)
          << k << " " << j;
}

TEST(Resample, IntoTheFirstAndLastIntervalAsWell) {
  const Clip out = resampled(turningClip(), 40.0);  // frames 0, 0.75, ... 3.75
  ASSERT_EQ(out.frameCount(), 6);
  EXPECT_LT((out.at(1, 2) - at3(0.165606, 1.6385819, 0.5570433)).norm(), 2e-6);
  EXPECT_LT((out.at(5, 2) - at3(1.6158769, 1.2662798, 0.5066102)).norm(), 2e-6);
}

TEST(Resample, ABoneKeepsItsLengthInEveryFrame) {
  const Clip in = turningClip(30);
  const auto lengths = boneLengths(*in.skeleton);
  const auto bones = in.skeleton->bones();
  for (const double fps : {20.0, 24.0, 25.0, 60.0}) {
    const Clip out = resampled(in, fps);
    for (int t = 0; t < out.frameCount(); ++t)
      for (size_t b = 0; b < bones.size(); ++b)
        // At 80 m floats are 7.6 um apart, and the sum at the bone's end is rounded once.
        ASSERT_NEAR((out.at(t, bones[b].second) - out.at(t, bones[b].first)).norm(), lengths[b],
                    1e-5f)
            << fps << " frame " << t;
    for (int t = 0; t < out.frameCount(); ++t)
      for (size_t j = 1; j < 4; ++j)
        ASSERT_EQ(out.transforms->translations[4 * static_cast<size_t>(t) + j],
                  in.skeleton->offsets[j]);
  }
}

TEST(Resample, OfPositionsAloneGoesByACubicThroughTheFrames) {
  // x = t^2 of the frames 0..4; worked out by hand: inside a parabola is met exactly, at the ends
  // the tangent is that of the last chord.
  const Clip out = resampled(withoutTransforms(turningClip()), 60.0);
  ASSERT_EQ(out.frameCount(), 9);
  EXPECT_NEAR(out.at(1, 0).x(), 0.1 * 0.375, 1e-6);  // 0.5 (0 + 1) + (1 - 2) / 8
  EXPECT_NEAR(out.at(3, 0).x(), 0.1 * 2.25, 1e-6);
  EXPECT_NEAR(out.at(5, 0).x(), 0.1 * 6.25, 1e-6);
  EXPECT_NEAR(out.at(7, 0).x(), 0.1 * 12.375, 1e-6);  // 0.5 (9 + 16) + (6 - 7) / 8
}

TEST(Resample, OfALineIsTheLineAndOfRestIsRestToTheBit) {
  Clip clip = withoutTransforms(turningClip());
  for (int t = 0; t < 5; ++t)
    for (int j = 0; j < 4; ++j) clip.frame(t)[j] = at3(0.7 * t, 0.1, 0.3);
  const Clip out = resampled(clip, 20.0);
  EXPECT_NEAR(out.at(1, 0).x(), 0.7 * 1.5, 1e-6);
  EXPECT_EQ(out.at(1, 3).y(), 0.1f);
  EXPECT_EQ(out.at(1, 3).z(), 0.3f);
}

TEST(Resample, FramesThatFallTogetherAreTakenOverToTheBitInBothKindsOfClip) {
  for (const Clip& in : {turningClip(), withoutTransforms(turningClip())}) {
    const Clip twice = resampled(in, 60.0), slower = resampled(in, 20.0);
    for (int j = 0; j < 4; ++j) {
      for (int t = 0; t < 5; ++t) EXPECT_EQ(twice.at(2 * t, j), in.at(t, j));
      EXPECT_EQ(slower.at(2, j), in.at(3, j));
    }
    EXPECT_EQ(resampled(twice, 30.0).positions, in.positions);
  }
}

TEST(Resample, PositionsThatAreNotThoseOfTheTransformsGoTheirOwnWay) {
  Clip clip = turningClip();
  for (Vec3& p : clip.positions) p += at3(0.0, 0.02, 0.0);
  const Clip out = resampled(clip, 20.0);
  EXPECT_EQ(out.positions, resampled(withoutTransforms(clip), 20.0).positions);
}

TEST(Resample, ARateThatIsNoRateIsRefused) {
  const Clip clip = steadyClip(3, 30.0);
  EXPECT_THROW(resampled(clip, 0.0), InputError);
  EXPECT_THROW(resampled(clip, -20.0), InputError);
  EXPECT_THROW(resampled(clip, std::numeric_limits<double>::quiet_NaN()), InputError);
}

}  // namespace
}  // namespace marey

#include "motion/resample.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"

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

TEST(Resample, ARateThatIsNoRateIsRefused) {
  const Clip clip = steadyClip(3, 30.0);
  EXPECT_THROW(resampled(clip, 0.0), InputError);
  EXPECT_THROW(resampled(clip, -20.0), InputError);
  EXPECT_THROW(resampled(clip, std::numeric_limits<double>::quiet_NaN()), InputError);
}

}  // namespace
}  // namespace marey

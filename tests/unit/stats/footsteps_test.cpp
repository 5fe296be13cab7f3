#include "stats/footsteps.h"

#include <cmath>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/resample.h"
#include "motion/walker.h"

namespace marey::stats {
namespace {

// At 10 fps one centimetre per frame is 10 cm/s.
TEST(Footsteps, AFootstepIsAMaximalRunOfFramesBelowTheTolerance) {
  const Clip clip = stepClip({0.001f, 0.002f, 0.5f, 0.003f, 0.003f, 0.003f, 0.6f}, 10.0);
  const auto curve = footstepCurve({clip}, {.feet = {0}});
  ASSERT_EQ(curve.toleranceCmS.size(), 200u);
  // Speeds in cm/s: 1, 2, 500, 3, 3, 3, 600. Below 1: nothing. Below 2: frame 1. Below 3: frames
  // 1-2. From 4 on: also frames 4-6.
  EXPECT_EQ(curve.count[1], 1);
  EXPECT_EQ(curve.count[2], 1);
  EXPECT_EQ(curve.count[4], 2);
  EXPECT_EQ(curve.count[199], 2);
  EXPECT_EQ(curve.maxCount, 2);
  // Runs of 2 and 3 frames: 0.2 s and 0.3 s.
  EXPECT_NEAR(curve.durationMeanS, 0.25, 1e-12);
  EXPECT_NEAR(curve.durationStdS, 0.05, 1e-12);
}

TEST(Footsteps, TheSpeedMustBeBelowTheToleranceNotAtIt) {
  // 0.25 m in a quarter of a second: exactly 100 cm/s in floating point.
  const Clip clip = stepClip({0.25f}, 4.0);
  const auto curve = footstepCurve({clip}, {.feet = {0}});
  EXPECT_EQ(curve.count[99], 0);   // 100 cm/s
  EXPECT_EQ(curve.count[100], 1);  // 101 cm/s
}

TEST(Footsteps, HeightDoesNotCount) {
  const Clip clip = pointClip({Vec3(0, 0, 0), Vec3(0, 5, 0), Vec3(0, -3, 0)}, 20.0);
  EXPECT_EQ(footstepCurve({clip}, {.feet = {0}}).count[0], 1);
}

TEST(Footsteps, RunsDoNotJoinAcrossClipsOrFeet) {
  const Clip clip = stepClip({0.0f, 0.0f}, 20.0);
  EXPECT_EQ(footstepCurve({clip, clip, clip}, {.feet = {0}}).maxCount, 3);
  EXPECT_EQ(footstepCurve({clip}, {.feet = {0, 0}}).maxCount, 2);
}

TEST(Footsteps, V95IsTheFirstToleranceWithAtLeastNinetyFivePerCentInWholeNumbers) {
  // 20 feet stand at different speeds: k feet are below k + 0.5 cm/s each in a clip of their own.
  std::vector<Clip> clips;
  for (int k = 1; k <= 20; ++k)
    clips.push_back(stepClip({static_cast<float>((k - 0.5) / 100.0)}, 1.0));
  const auto curve = footstepCurve(clips, {.feet = {0}});
  EXPECT_EQ(curve.maxCount, 20);
  // 19 of 20 are exactly 95 %.
  EXPECT_EQ(curve.count[18], 19);
  EXPECT_EQ(curve.v95CmS, 19.0);
}

TEST(Footsteps, TolerancesAreMultiplesOfTheStepUpToTwoMetresPerSecond) {
  const auto dog = footstepTolerances({.feet = {0}, .stepCmS = 0.3});
  ASSERT_EQ(dog.size(), 666u);
  EXPECT_EQ(dog[2], 0.9);
  EXPECT_EQ(dog.back(), 199.8);
  const auto human = footstepTolerances({.feet = {0}});
  EXPECT_EQ(human.front(), 1.0);
  EXPECT_EQ(human.back(), 200.0);
}

TEST(Footsteps, NoFootstepGivesNoV95) {
  const auto curve = footstepCurve({stepClip({5.0f, 5.0f}, 20.0)}, {.feet = {0}});
  EXPECT_EQ(curve.maxCount, 0);
  EXPECT_TRUE(std::isnan(curve.v95CmS));
}

TEST(Footsteps, WeightsCountAClipSeveralTimes) {
  const FootstepOptions options{.feet = {0}};
  const Clip one = stepClip({0.0f, 0.5f, 0.0f}, 20.0);
  const Clip other = stepClip({0.0f, 0.5f, 0.5f}, 20.0);
  const auto weighted =
      curveOf(footstepTolerances(options),
              {footstepTally(one, options), footstepTally(other, options)}, {2, 3});
  const auto repeated = footstepCurve({one, one, other, other, other}, options);
  EXPECT_EQ(weighted.count, repeated.count);
  EXPECT_NEAR(weighted.durationMeanS, repeated.durationMeanS, 1e-12);
}

TEST(Footsteps, SeveralSamplesPerControlCountPerControl) {
  // Two samples along control 7 with 1 and 3 steps at the lowest tolerance, one along 9 with 2.
  const Clip one = stepClip({0.0f, 0.5f}, 20.0);
  const Clip three = stepClip({0.0f, 0.5f, 0.0f, 0.5f, 0.0f}, 20.0);
  const Clip two = stepClip({0.0f, 0.5f, 0.0f}, 20.0);
  const auto curve = footstepCurve({one, three, two}, {.feet = {0}}, {7, 7, 9});
  EXPECT_NEAR(curve.count[0], 2.0 + 2.0, 1e-12);
  // Lengths likewise: frames (3 + 6) / 2 + 4, at 20 fps.
  EXPECT_NEAR(curve.lengthS, 8.5 / 20.0, 1e-12);
  EXPECT_NEAR(curve.stepsPerS, 4.0 / (8.5 / 20.0), 1e-9);
  EXPECT_EQ(curve.v95CmS, 1.0);
}

TEST(Footsteps, SharesOfAThirdReachNinetyFivePercentWhereTheyAreTheMaximum) {
  const Clip clip = stepClip({0.0f, 0.5f, 0.0f, 0.03f}, 20.0);
  const auto curve = footstepCurve({clip, clip, clip}, {.feet = {0}}, {0, 0, 0});
  EXPECT_NEAR(curve.maxCount, 2.0, 1e-12);
  EXPECT_EQ(curve.v95CmS, 1.0);
}

TEST(Footsteps, WrongInputIsRefused) {
  const Clip clip = stepClip({0.0f}, 20.0);
  EXPECT_THROW(footstepCurve({}, {.feet = {0}}), InputError);
  EXPECT_THROW(footstepCurve({clip}, {}), InputError);
  EXPECT_THROW(footstepCurve({clip}, {.feet = {1}}), InputError);
  EXPECT_THROW(footstepCurve({clip}, {.feet = {0}, .stepCmS = 0.0}), InputError);
}

TEST(Footsteps, FeetAreFoundByNameOrByHabit) {
  const auto walker = walkerSkeleton();
  const std::vector<int> ankles = {walker->find("LeftFoot"), walker->find("RightFoot")};
  EXPECT_EQ(feetOf(*walker), ankles);
  EXPECT_EQ(feetOf(*walker, "RightFoot"), std::vector<int>{ankles[1]});
  EXPECT_THROW(feetOf(*walker, "Hoof"), InputError);
}

TEST(Footsteps, ContactIntervalsNameTheirFrames) {
  const Clip clip = stepClip({0.0f, 0.5f, 0.0f, 0.0f}, 10.0);
  const auto contacts = contactIntervals(clip, {0}, 5.0);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].firstFrame, 1);
  EXPECT_EQ(contacts[0].lastFrame, 1);
  EXPECT_EQ(contacts[1].firstFrame, 3);
  EXPECT_EQ(contacts[1].lastFrame, 4);
  EXPECT_NEAR(contacts[1].seconds, 0.2, 1e-12);
}

/// Contacts of the truth that are long enough to hold two frames.
std::vector<Contact> visible(const WalkerTruth& truth, int joint, double fps) {
  std::vector<Contact> out;
  for (const Contact& c : truth.contacts)
    if (c.joint == joint && std::floor(c.endS * fps) > std::ceil(c.beginS * fps)) out.push_back(c);
  return out;
}

TEST(Footsteps, OfTheWalkerAreItsKnownContactsWithinOneFrame) {
  for (const char* preset : {"still", "slow", "fast", "sideways", "backward", "turn-left"}) {
    for (double fps : {60.0, 20.0}) {
      const WalkerClip w = walk(presetPath(preset, 8.0, 60.0), {.seed = 9, .fps = 60.0});
      const Clip clip = resampled(w.clip, fps);
      for (int joint : feetOf(*clip.skeleton)) {
        const auto known = visible(w.truth, joint, fps);
        const auto found = contactIntervals(clip, {joint}, 1.0);
        ASSERT_EQ(found.size(), known.size()) << preset << " at " << fps << " fps";
        for (size_t i = 0; i < known.size(); ++i) {
          // A frame is slow when it and the one before lie in the contact.
          const int first = static_cast<int>(std::ceil(known[i].beginS * fps)) + 1;
          const int last = static_cast<int>(std::floor(known[i].endS * fps));
          EXPECT_NEAR(found[i].firstFrame, first, 1) << preset << " at " << fps << " fps";
          EXPECT_NEAR(found[i].lastFrame, last, 1) << preset << " at " << fps << " fps";
        }
      }
    }
  }
}

TEST(Footsteps, OfTheWalkerAreCountedAtTheLowestTolerance) {
  const WalkerClip w = walk(presetPath("fast", 10.0, 60.0), {.seed = 4, .fps = 60.0});
  const Clip clip = resampled(w.clip, 20.0);
  const auto feet = feetOf(*clip.skeleton);
  const auto curve = footstepCurve({clip}, {.feet = feet});
  const auto known =
      visible(w.truth, feet[0], 20.0).size() + visible(w.truth, feet[1], 20.0).size();
  EXPECT_EQ(curve.maxCount, static_cast<double>(known));
  EXPECT_EQ(curve.v95CmS, 1.0);
}

TEST(Footsteps, OfTheWalkerLastAsLongAsItsContactsWithinOneFrame) {
  const WalkerClip w = walk(presetPath("fast", 10.0, 60.0), {.seed = 4, .fps = 60.0});
  const auto curve = footstepCurve({w.clip}, {.feet = feetOf(*w.clip.skeleton)});
  double seconds = 0.0;
  for (const Contact& c : w.truth.contacts) seconds += c.endS - c.beginS;
  EXPECT_NEAR(curve.durationMeanS, seconds / static_cast<double>(w.truth.contacts.size()),
              1.0 / 60.0);
}

}  // namespace
}  // namespace marey::stats

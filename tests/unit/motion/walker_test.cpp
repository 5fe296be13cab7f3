#include "motion/walker.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/resample.h"

namespace marey {
namespace {

const std::vector<WalkerClip>& dataSet() {
  static const std::vector<WalkerClip> clips = walkerDataSet(28, 6.0, 11);
  return clips;
}

WalkerClip walkPreset(const std::string& preset, double seconds, double fps = 60.0,
                      uint64_t seed = 3) {
  return walk(presetPath(preset, seconds, fps), {.seed = seed, .fps = fps});
}

std::pair<int, int> framesInside(const Contact& contact, double fps) {
  return {static_cast<int>(std::ceil(contact.beginS * fps)),
          static_cast<int>(std::floor(contact.endS * fps))};
}

double horizontalSpeed(const Clip& clip, int t, int joint) {
  const Vec3 d = clip.at(t, joint) - clip.at(t - 1, joint);
  return std::hypot(d.x(), d.z()) * clip.fps;
}

TEST(Walker, HasTheTopologyOfTheMoGlowHuman) {
  const auto skeleton = walkerSkeleton();
  const std::vector<int> parents = {-1, 0,  1,  2,  3,  0,  5,  6,  7,  0, 9,
                                    10, 11, 11, 13, 14, 15, 11, 17, 18, 19};
  EXPECT_EQ(skeleton->parents, parents);
  EXPECT_NO_THROW(validate(*skeleton, "walker"));
}

TEST(Walker, StandsAboutOneMetreSeventyFiveTall) {
  const Clip clip = walkPreset("still", 1.0).clip;
  const int head = clip.skeleton->find("Head");
  // The head joint and the top of the head above it.
  EXPECT_NEAR(clip.at(0, head).y() + 0.12, 1.75, 0.06);
}

TEST(Walker, AnAnkleInContactKeepsItsPositionBitForBit) {
  for (const WalkerClip& w : dataSet()) {
    ASSERT_FALSE(w.truth.contacts.empty()) << w.clip.name;
    for (const Contact& contact : w.truth.contacts) {
      const auto [first, last] = framesInside(contact, w.clip.fps);
      for (int t = first + 1; t <= last; ++t)
        ASSERT_EQ(w.clip.at(t, contact.joint), w.clip.at(first, contact.joint))
            << w.clip.name << " frame " << t;
    }
  }
}

TEST(Walker, ToesKeepTheirPositionBitForBitWhileTheFootIsFlat) {
  const WalkerClip w = walkPreset("fast", 5.0);
  for (const Contact& contact : w.truth.contacts) {
    auto [first, last] = framesInside(contact, 60.0);
    // From the moment the toes have come down.
    while (first < last &&
           w.clip.at(first, contact.joint + 1).y() != w.clip.at(last, contact.joint + 1).y())
      ++first;
    EXPECT_LT(first - contact.beginS * 60.0, 10.0);
    for (int t = first + 1; t <= last; ++t)
      ASSERT_EQ(w.clip.at(t, contact.joint + 1), w.clip.at(first, contact.joint + 1));
  }
}

TEST(Walker, AnAnkleOutsideItsContactsMoves) {
  const WalkerClip w = walkPreset("fast", 5.0);
  const int ankle = w.clip.skeleton->find("LeftFoot");
  for (int t = 1; t < w.clip.frameCount(); ++t) {
    const double from = (t - 1) / 60.0;
    const double to = t / 60.0;
    const bool planted = std::any_of(
        w.truth.contacts.begin(), w.truth.contacts.end(),
        [&](const Contact& c) { return c.joint == ankle && from < c.endS && to > c.beginS; });
    if (planted) continue;
    EXPECT_GT(horizontalSpeed(w.clip, t, ankle), 0.01) << "frame " << t;
  }
}

TEST(Walker, ContactsStayExactAfterHalvingTheFrameRate) {
  const WalkerClip w = walkPreset("slow", 4.0);
  const Clip slow = resampled(w.clip, 20.0);
  for (const Contact& contact : w.truth.contacts) {
    const auto [first, last] = framesInside(contact, 20.0);
    for (int t = first + 1; t <= std::min(last, slow.frameCount() - 1); ++t)
      ASSERT_EQ(slow.at(t, contact.joint), slow.at(first, contact.joint));
  }
}

TEST(Walker, BoneLengthsAreConstantWithinTenMicrometres) {
  for (const WalkerClip& w : dataSet()) {
    const auto bones = w.clip.skeleton->bones();
    for (int t = 0; t < w.clip.frameCount(); ++t)
      for (size_t b = 0; b < bones.size(); ++b)
        ASSERT_NEAR((w.clip.at(t, bones[b].first) - w.clip.at(t, bones[b].second)).norm(),
                    w.truth.boneLengthsM[b], 1e-5)
            << w.clip.name << " frame " << t;
  }
}

TEST(Walker, LocalTransformsGiveTheSamePositions) {
  for (const WalkerClip& w : dataSet()) {
    const Clip& clip = w.clip;
    ASSERT_TRUE(clip.transforms.has_value());
    for (int t = 0; t < clip.frameCount(); t += 7) {
      std::vector<Eigen::Quaterniond> world(21);
      std::vector<Eigen::Vector3d> place(21);
      for (int j = 0; j < 21; ++j) {
        const size_t i = static_cast<size_t>(t) * 21 + j;
        const Eigen::Quaterniond q = clip.transforms->rotations[i].cast<double>();
        const Eigen::Vector3d d = clip.transforms->translations[i].cast<double>();
        const int parent = clip.skeleton->parents[j];
        world[j] = parent < 0 ? q : world[parent] * q;
        place[j] = parent < 0 ? d : place[parent] + world[parent] * d;
        ASSERT_LT((place[j] - clip.at(t, j).cast<double>()).norm(), 2e-5)
            << clip.name << " frame " << t << " joint " << j;
      }
    }
  }
}

TEST(Walker, KneesBendForwardsAndNoJointIsBelowTheFloor) {
  for (const WalkerClip& w : dataSet()) {
    for (int t = 0; t < w.clip.frameCount(); ++t) {
      const Vec3 left = w.clip.at(t, 1) - w.clip.at(t, 5);
      const Vec3 ahead = left.cross(Vec3::UnitY()).normalized();
      for (int hip : {1, 5}) {
        const Vec3 middle = 0.5f * (w.clip.at(t, hip) + w.clip.at(t, hip + 2));
        ASSERT_GT((w.clip.at(t, hip + 1) - middle).dot(ahead), -0.02f)
            << w.clip.name << " frame " << t;
      }
      for (const Vec3& p : w.clip.frame(t)) ASSERT_GT(p.y(), 0.0f);
    }
  }
}

TEST(Walker, HipsFollowThePath) {
  const auto path = presetPath("figure-eight", 8.0, 60.0);
  const Clip clip = walk(path, {.fps = 60.0}).clip;
  ASSERT_EQ(clip.frameCount(), static_cast<int>(path.size()));
  for (int t = 0; t < clip.frameCount(); ++t)
    ASSERT_LT(std::hypot(clip.at(t, 0).x() - path[t].x, clip.at(t, 0).z() - path[t].z), 0.08);
}

TEST(Walker, StandingStillPlantsBothFeetForTheWholeClipWhileTheBodySways) {
  const WalkerClip w = walkPreset("still", 8.0);
  ASSERT_EQ(w.truth.contacts.size(), 2u);
  for (const Contact& contact : w.truth.contacts) {
    EXPECT_EQ(contact.beginS, 0.0);
    EXPECT_NEAR(contact.endS, 8.0, 0.05);
  }
  EXPECT_TRUE(w.truth.stepTimesS.empty());
  double travel = 0.0;
  for (int t = 1; t < w.clip.frameCount(); ++t)
    travel = std::max(travel, static_cast<double>((w.clip.at(t, 0) - w.clip.at(0, 0)).norm()));
  EXPECT_GT(travel, 0.002);
  EXPECT_LT(travel, 0.08);
}

TEST(Walker, TurningOnTheSpotTakesSmallCorrectiveSteps) {
  std::vector<RootFrame> path(480);
  for (size_t t = 0; t < path.size(); ++t) path[t].heading = 0.6 * static_cast<double>(t) / 60.0;
  const WalkerClip w = walk(path, {.fps = 60.0});
  EXPECT_GE(w.truth.contacts.size(), 6u);
  for (int t = 0; t < w.clip.frameCount(); ++t)
    EXPECT_LT(std::hypot(w.clip.at(t, 3).x(), w.clip.at(t, 3).z()), 0.35);
}

TEST(Walker, FeetAlternateAndStepTimesAreTheGapsBetweenTouchDowns) {
  const WalkerClip w = walkPreset("fast", 6.0);
  std::vector<Contact> landings;
  for (const Contact& c : w.truth.contacts)
    if (c.beginS > 0.0) landings.push_back(c);
  ASSERT_EQ(landings.size(), w.truth.stepTimesS.size() + 1);
  for (size_t i = 1; i < landings.size(); ++i) {
    EXPECT_NE(landings[i].joint, landings[i - 1].joint);
    EXPECT_NEAR(landings[i].beginS - landings[i - 1].beginS, w.truth.stepTimesS[i - 1], 1e-9);
    EXPECT_GT(w.truth.stepTimesS[i - 1], 0.3);
    EXPECT_LT(w.truth.stepTimesS[i - 1], 0.6);
  }
}

TEST(Walker, FasterWalkingTakesLongerAndQuickerSteps) {
  const auto meanStep = [](const std::string& preset) {
    const auto times = walkPreset(preset, 10.0).truth.stepTimesS;
    double sum = 0.0;
    for (double t : times) sum += t;
    return sum / static_cast<double>(times.size());
  };
  const double slow = meanStep("slow");
  const double fast = meanStep("fast");
  EXPECT_GT(slow, 1.2 * fast);
  EXPECT_GT(1.9 * fast, 1.2 * 0.7 * slow);
}

TEST(Walker, TheSamePlanAppearsAtAnyFrameRate) {
  const auto at60 = walk(presetPath("slow", 5.0, 60.0), {.fps = 60.0}).truth.contacts;
  const auto at120 = walk(presetPath("slow", 5.0, 120.0), {.fps = 120.0}).truth.contacts;
  ASSERT_EQ(at60.size(), at120.size());
  for (size_t i = 0; i < at60.size(); ++i) EXPECT_NEAR(at60[i].beginS, at120[i].beginS, 0.011);
}

TEST(Walker, TheSameSeedGivesTheSameBitsAndAnotherSeedAnotherWalk) {
  const Clip a = walkPreset("slow", 3.0, 60.0, 5).clip;
  EXPECT_EQ(a.positions, walkPreset("slow", 3.0, 60.0, 5).clip.positions);
  EXPECT_NE(a.positions, walkPreset("slow", 3.0, 60.0, 6).clip.positions);
}

TEST(Walker, NoiseOfZeroStillsTheBodyOfAStandingWalker) {
  const auto path = presetPath("still", 3.0, 60.0);
  const Clip clip = walk(path, {.fps = 60.0, .noise = 0.0}).clip;
  for (int t = 1; t < clip.frameCount(); ++t)
    for (int j = 0; j < 21; ++j) ASSERT_EQ(clip.at(t, j), clip.at(0, j));
}

TEST(Walker, TheDataSetShowsEveryKindOfPathAndEveryStyle) {
  std::set<std::string> kinds;
  std::set<std::string> styles;
  for (const WalkerClip& w : dataSet()) {
    for (const WalkerStyle& style : walkerStyles()) {
      const size_t at = w.clip.name.rfind("-" + style.name);
      if (at == std::string::npos || at + style.name.size() + 1 != w.clip.name.size()) continue;
      styles.insert(style.name);
      kinds.insert(w.clip.name.substr(11, at - 11));
    }
  }
  EXPECT_EQ(styles.size(), walkerStyles().size());
  for (const char* kind : {"still", "slow", "normal", "fast", "sideways-left", "sideways-right",
                           "backward", "turn-left", "turn-right", "speed-changes", "stop-and-go"})
    EXPECT_TRUE(kinds.count(kind)) << kind;
}

TEST(Walker, StylesDifferInHipHeightAndStepLength) {
  const auto path = presetPath("slow", 6.0, 60.0);
  const auto hips = [&](const std::string& style) {
    return walk(path, {.style = style, .fps = 60.0}).clip.at(100, 0).y();
  };
  EXPECT_GT(hips("proud"), hips("crouched") + 0.08f);
  const auto steps = [&](const std::string& style) {
    return walk(path, {.style = style, .fps = 60.0}).truth.stepTimesS.size();
  };
  EXPECT_GT(steps("short-quick"), steps("long-stride"));
}

TEST(Walker, UnknownStylesAndImpossiblePathsAreRefused) {
  EXPECT_THROW(walk({RootFrame{}}, {.style = "moonwalk"}), InputError);
  EXPECT_THROW(walk({}, {}), InputError);
  EXPECT_THROW(walk({RootFrame{.x = NAN}}, {}), InputError);
  std::vector<RootFrame> leap(120);
  for (int t = 60; t < 120; ++t) leap[t].z = 5.0;
  EXPECT_THROW(walk(leap, {.fps = 60.0}), InputError);
  EXPECT_THROW(walkerDataSet(0, 5.0, 1), InputError);
  EXPECT_THROW(walkerDataSet(1, 0.0, 1), InputError);
}

TEST(Walker, ASingleRootFrameGivesOneFrame) {
  const WalkerClip w = walk({RootFrame{.x = 1.0, .z = 2.0, .heading = 0.5}}, {});
  EXPECT_EQ(w.clip.frameCount(), 1);
  EXPECT_NEAR(w.clip.at(0, 0).x(), 1.0, 0.05);
}

}  // namespace
}  // namespace marey

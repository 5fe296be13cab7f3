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

// The walker's own figures: a gait is drawn from a style with factors exp(s n) of a normal number n
// that is cut at 2.
const double kWidestGait = std::exp(0.10 * 2), kLongestGait = std::exp(0.06 * 2),
             kQuickestGait = std::exp(0.04 * 2);
constexpr double kWalkRatio = 0.39;  ///< m s, step length over cadence (Sekiya et al. 1996)
constexpr double kLongestStepM = 0.85;
constexpr double kFewestStepsHz = 1.25;
constexpr double kJitter = 0.03;   ///< of a swing, cut at 2
constexpr double kScatterM = 0.012;  ///< of a foot's place in either direction, cut at 2
constexpr double kFlatAfter = 0.12;  ///< of a step's time, after which the toes are down

/// Half the width of the steps of the normal style, at most.
double halfWidestStepM() {
  return 0.5 * kWidestGait * walkerStyles().front().stepWidthM;
}

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

TEST(Walker, HasTheTopologyOfTheMoGlowHuman) {
  const auto skeleton = walkerSkeleton();
  const std::vector<int> parents = {-1, 0,  1,  2,  3,  0,  5,  6,  7,  0, 9,
                                    10, 11, 11, 13, 14, 15, 11, 17, 18, 19};
  EXPECT_EQ(skeleton->parents, parents);
  EXPECT_NO_THROW(validate(*skeleton, "walker"));
}

TEST(Walker, StandsAboutOneMetreSeventyFiveTall) {
  const Clip clip = walkPreset("still", 1.0).clip;
  const Skeleton& body = *clip.skeleton;
  double straight = 0.12;  // the top of the head above its joint
  for (int j = body.find("Head"); j >= 0; j = body.parents[static_cast<size_t>(j)])
    straight += static_cast<double>(body.offsets[static_cast<size_t>(j)].y());
  EXPECT_NEAR(straight, 1.75, 0.01);
  // Who stands is no taller than straight, and as much lower as he crouches, breathes and leans.
  const WalkerStyle& normal = walkerStyles().front();
  const double top = static_cast<double>(clip.at(0, body.find("Head")).y()) + 0.12;
  EXPECT_LE(top, straight);
  EXPECT_GE(top, straight - (normal.crouchM + 0.006 * 2) - normal.bounceM);
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
  const double longest = kLongestStepM / 1.9 * (1.0 + 2 * kJitter);  // of a step at 1.9 m/s, s
  for (const Contact& contact : w.truth.contacts) {
    auto [first, last] = framesInside(contact, 60.0);
    // From the moment the toes have come down.
    while (first < last &&
           w.clip.at(first, contact.joint + 1).y() != w.clip.at(last, contact.joint + 1).y())
      ++first;
    // From the frame after the landing to the one after the toes are down.
    EXPECT_LE(first - contact.beginS * 60.0, 2.0 + kFlatAfter * longest * 60.0);
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
    EXPECT_NE(w.clip.at(t, ankle), w.clip.at(t - 1, ankle)) << "frame " << t;
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
    // A body is never beside its feet.
    ASSERT_LT(std::hypot(clip.at(t, 0).x() - path[t].x, clip.at(t, 0).z() - path[t].z),
              halfWidestStepM());
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
  EXPECT_GT(travel, 0.0);
  EXPECT_LT(travel, halfWidestStepM()) << "the body is above its feet";
}

TEST(Walker, TurningOnTheSpotTakesSmallCorrectiveSteps) {
  std::vector<RootFrame> path(480);
  for (size_t t = 0; t < path.size(); ++t) path[t].heading = 0.6 * static_cast<double>(t) / 60.0;
  const WalkerClip w = walk(path, {.fps = 60.0});
  // A foot stays until it is 0.22 rad away from where it should be, and is put where it should be
  // within a pair of steps.
  const double pairS = 2.0 * kQuickestGait / kFewestStepsHz;
  const auto steps = static_cast<size_t>(0.6 * 8.0 / (0.22 + 0.6 * pairS));
  EXPECT_GE(w.truth.contacts.size(), 2 * (1 + steps));
  // It stands half a step's width beside the root and 2 cm behind it, but for its scatter.
  const double farthest =
      std::hypot(halfWidestStepM() + 2 * kScatterM, 0.02 + 2 * kScatterM);
  for (int t = 0; t < w.clip.frameCount(); ++t)
    EXPECT_LT(std::hypot(w.clip.at(t, 3).x(), w.clip.at(t, 3).z()), farthest);
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
    // Step length over speed; a swing's jitter is at most all of it.
    const double free = std::sqrt(kWalkRatio * 1.9);
    EXPECT_GT(w.truth.stepTimesS[i - 1], free / kLongestGait / 1.9 * (1.0 - 2 * kJitter));
    EXPECT_LT(w.truth.stepTimesS[i - 1],
              std::min(kLongestStepM, free * kLongestGait) / 1.9 * (1.0 + 2 * kJitter));
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
  // Of one gait, whose factor is the same at 0.7 and 1.9 m/s: the step times are as
  // sqrt(0.39 v) / v but for the longest step; four standard errors of the jitter of nine steps.
  const double free = std::sqrt(1.9 / 0.7), jitter = 4 * kJitter / 3;
  EXPECT_GT(slow, free * (1.0 - jitter) * fast);
  // Slow steps are no slower than the slowest cadence.
  const double slowest = kQuickestGait / kFewestStepsHz;
  const double quickest = std::min(kLongestStepM, std::sqrt(kWalkRatio * 1.9)) / 1.9;
  EXPECT_GT(1.9 * fast, (1.9 * quickest) / (0.7 * slowest) * (1.0 - jitter) * 0.7 * slow);
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

#include "motion/path_edit.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

constexpr double kPi = std::numbers::pi;

WayPoint point(double x, double z, std::optional<double> timeS = {},
               std::optional<double> speedMS = {}, std::optional<double> facing = {}) {
  return {.x = x, .z = z, .timeS = timeS, .speedMS = speedMS, .facing = facing};
}

double furthest(const std::vector<RootFrame>& a, const std::vector<RootFrame>& b) {
  double out = 0.0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    out = std::max(out, std::hypot(a[i].x - b[i].x, a[i].z - b[i].z));
  return out;
}

TEST(PathEdit, FewerThanTwoWayPointsAreRefused) {
  EXPECT_THROW(PathEdit({}), InputError);
  EXPECT_THROW(PathEdit({point(0, 0)}), InputError);
}

TEST(PathEdit, TwoWayPointsAreAlwaysLeft) {
  PathEdit edit({point(0, 0), point(0, 1), point(0, 2)});
  EXPECT_TRUE(edit.remove(1));
  EXPECT_FALSE(edit.remove(0));
  EXPECT_FALSE(edit.remove(1));
  EXPECT_EQ(edit.size(), 2u);
  EXPECT_THROW(edit.remove(2), std::out_of_range);
}

TEST(PathEdit, APlaceOnTheLineGoesBetweenItsNeighbours) {
  PathEdit edit({point(0, 0), point(0, 2), point(0, 4)});
  EXPECT_EQ(edit.add(0.1, 3.0), 2u);
  ASSERT_EQ(edit.size(), 4u);
  EXPECT_DOUBLE_EQ(edit.points()[2].x, 0.1);
  EXPECT_DOUBLE_EQ(edit.points()[2].z, 3.0);
}

TEST(PathEdit, APlaceAwayFromTheLineIsWalkedLast) {
  PathEdit edit({point(0, 0), point(0, 4)});
  // Nearer to the start, and still the last one: loops can be drawn.
  EXPECT_EQ(edit.add(-1.0, 0.0), 2u);
  EXPECT_DOUBLE_EQ(edit.points().back().x, -1.0);
}

TEST(PathEdit, APlaceBetweenTimesTakesATimeBetween) {
  PathEdit edit({point(0, 0, 0.0), point(0, 4, 8.0)});
  ASSERT_EQ(edit.add(0.0, 1.0), 1u);
  ASSERT_TRUE(edit.points()[1].timeS);
  EXPECT_NEAR(*edit.points()[1].timeS, 2.0, 1e-6);
}

TEST(PathEdit, APlaceBetweenFacingsTurnsTheShortWay) {
  PathEdit edit({point(0, 0, {}, {}, 0.9 * kPi), point(0, 2, {}, {}, -0.9 * kPi)});
  ASSERT_EQ(edit.add(0.0, 1.0), 1u);
  ASSERT_TRUE(edit.points()[1].facing);
  EXPECT_NEAR(*edit.points()[1].facing, kPi, 1e-6);
}

TEST(PathEdit, APlaceBehindATimedPathIsWalkedAtItsLastSpeed) {
  PathEdit edit({point(0, 0, 0.0), point(0, 1, 2.0)});
  edit.add(0.0, 3.0);
  const auto times = arrivalTimes(edit.points());
  EXPECT_NEAR(times.back(), 6.0, 1e-3);
}

TEST(PathEdit, AWayPointFacesAPlaceOnTheFloor) {
  PathEdit edit({WayPoint{.x = 1.0, .z = 2.0, .timeS = {}, .speedMS = {}, .facing = {}},
                 WayPoint{.x = 1.0, .z = 5.0, .timeS = {}, .speedMS = {}, .facing = {}}});
  edit.face(0, 1.0, 2.0);
  EXPECT_FALSE(edit.points()[0].facing) << "there is no direction to itself";
  edit.face(0, 3.0, 2.0);
  EXPECT_NEAR(*edit.points()[0].facing, std::atan2(1.0, 0.0), 1e-12);
  edit.face(0, 1.0, -1.0);
  EXPECT_NEAR(std::abs(*edit.points()[0].facing), std::atan2(0.0, -1.0), 1e-12);
  EXPECT_THROW(edit.face(2, 0.0, 0.0), std::out_of_range);
}

TEST(PathEdit, WhatFollowsARemovedWayPointKeepsItsSpeed) {
  PathEdit edit({point(0, 0, {}, 1.0), point(0, 1, {}, 0.5), point(0, 2), point(0, 3)});
  ASSERT_TRUE(edit.remove(1));
  EXPECT_EQ(edit.points()[1].speedMS, 0.5);
}

TEST(PathEdit, RemovingTheStartKeepsTheTimesOfTheRest) {
  PathEdit edit({point(0, 0, {}, 1.0), point(0, 1), point(0, 2, 2.0)});
  ASSERT_TRUE(edit.remove(0));
  const auto times = arrivalTimes(edit.points());
  EXPECT_NEAR(times.front(), 1.0, 1e-3);
  EXPECT_NEAR(times.back(), 2.0, 1e-9);
}

TEST(PathEdit, ValuesAreKeptWherePathsAreValid) {
  PathEdit edit({point(0, 0, 0.0), point(0, 1, 1.0), point(0, 2, 2.0)});
  edit.setTime(1, 5.0);
  EXPECT_LT(*edit.points()[1].timeS, 2.0);
  edit.setTime(1, -1.0);
  EXPECT_GT(*edit.points()[1].timeS, 0.0);
  edit.setSpeed(0, -3.0);
  EXPECT_DOUBLE_EQ(*edit.points()[0].speedMS, kSlowestMS);
  edit.move(0, NAN, 0.0);
  EXPECT_DOUBLE_EQ(edit.points()[0].x, 0.0);
  EXPECT_NO_THROW(samplePath(edit.points(), 20.0, "test"));
  edit.setTime(1, {});
  edit.setSpeed(0, {});
  edit.setFacing(0, 1.0);
  edit.setFacing(0, {});
  EXPECT_FALSE(edit.points()[1].timeS || edit.points()[0].speedMS || edit.points()[0].facing);
}

TEST(PathEdit, ArrivalTimesAreThoseOfTheSampledPath) {
  const std::vector<WayPoint> points = {point(0, 0, {}, 0.8), point(1, 2), point(3, 1, {}, 1.6),
                                        point(4, 4)};
  const auto frames = samplePath(points, 200.0, "test");
  const auto times = arrivalTimes(points);
  EXPECT_NEAR(times.back(), static_cast<double>(frames.size() - 1) / 200.0, 0.01);
  for (size_t i = 0; i < points.size(); ++i) {
    const auto k = std::min(frames.size() - 1, static_cast<size_t>(std::lround(times[i] * 200.0)));
    EXPECT_NEAR(frames[k].x, points[i].x, 0.02);
    EXPECT_NEAR(frames[k].z, points[i].z, 0.02);
  }
}

TEST(PathEdit, PresetsAreMatchedByTheirWayPoints) {
  for (const PathPreset& preset : pathPresets()) {
    const auto frames = presetPath(preset.name, 10.0, 20.0);
    const auto points = fitWayPoints(frames, 20.0);
    const auto again = samplePath(points, 20.0, preset.name);
    ASSERT_EQ(again.size(), frames.size()) << preset.name;
    EXPECT_LT(furthest(frames, again), 0.15) << preset.name;
    for (size_t i = 0; i < frames.size(); ++i)
      EXPECT_LT(std::abs(std::remainder(frames[i].heading - again[i].heading, 2.0 * kPi)), 0.35)
          << preset.name << " frame " << i;
  }
}

TEST(PathEdit, AShortMotionGetsTwoWayPoints) {
  const auto points = fitWayPoints({{0, 0, 0}, {0, 0.05, 0}, {0, 0.1, 0}}, 20.0);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_FALSE(points[0].facing) << "walks where it faces";
  EXPECT_THROW(fitWayPoints({{0, 0, 0}}, 20.0), InputError);
}

}  // namespace
}  // namespace marey

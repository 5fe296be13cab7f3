#include "motion/path.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

constexpr double kPi = std::numbers::pi;

WayPoint point(double x, double z, std::optional<double> timeS = {},
               std::optional<double> speedMS = {}, std::optional<double> facing = {}) {
  return {.x = x, .z = z, .timeS = timeS, .speedMS = speedMS, .facing = facing};
}

double stepLength(const std::vector<RootFrame>& path, size_t i) {
  return std::hypot(path[i].x - path[i - 1].x, path[i].z - path[i - 1].z);
}

std::string temporaryFile(const std::string& name, const std::string& content) {
  static const test::TempFolder folder;
  const auto path = folder / name;
  std::ofstream(path) << content;
  return path.string();
}

TEST(Path, ASpeedOnAStraightLineIsKeptExactly) {
  const auto path = samplePath({point(0, 0, {}, 0.5), point(0, 2), point(0, 3)}, 20.0, "test");
  // 3 m at 0.5 m/s take 6 s: frames 0..120.
  ASSERT_EQ(path.size(), 121u);
  for (size_t i = 0; i < path.size(); ++i) {
    EXPECT_NEAR(path[i].z, 0.5 * static_cast<double>(i) / 20.0, 1e-6);
    EXPECT_NEAR(path[i].x, 0.0, 1e-9);
    EXPECT_NEAR(path[i].heading, 0.0, 1e-9);
  }
}

TEST(Path, WayPointsAreReachedAtTheirTimes) {
  const auto path = samplePath(
      {point(0, 0, 0.0), point(1, 1, 1.0), point(2, 0, 2.5), point(4, 0, 4.0)}, 10.0, "t");
  ASSERT_EQ(path.size(), 41u);
  EXPECT_NEAR(path[10].x, 1.0, 1e-6);
  EXPECT_NEAR(path[10].z, 1.0, 1e-6);
  EXPECT_NEAR(path[25].x, 2.0, 1e-6);
  EXPECT_NEAR(path[25].z, 0.0, 1e-6);
  EXPECT_NEAR(path[40].x, 4.0, 1e-6);
}

TEST(Path, HeadingFollowsTheLineByDefault) {
  const auto path = samplePath({point(0, 0), point(3, 0)}, 20.0, "test");
  // Along +X, which is to the left of +Z.
  for (const RootFrame& frame : path) EXPECT_NEAR(frame.heading, kPi / 2.0, 1e-9);
}

TEST(Path, AFacingTurnsTheWalkerAwayFromTheLine) {
  const auto path = samplePath({point(0, 0, {}, {}, 0.0), point(3, 0, {}, {}, 0.0)}, 20.0, "test");
  for (const RootFrame& frame : path) EXPECT_NEAR(frame.heading, 0.0, 1e-9);
}

TEST(Path, HeadingsAreContinuousAcrossHalfATurn) {
  std::vector<WayPoint> circle;
  for (int i = 0; i <= 16; ++i)
    circle.push_back(point(2 * std::sin(i * kPi / 4), 2 * std::cos(i * kPi / 4)));
  const auto path = samplePath(circle, 30.0, "test");
  for (size_t i = 1; i < path.size(); ++i)
    EXPECT_LT(std::abs(path[i].heading - path[i - 1].heading), 0.1);
  // Two turns; at each end the line leaves the circle by up to half of its 45 degrees.
  EXPECT_NEAR(std::abs(path.back().heading - path.front().heading), 4 * kPi, kPi / 4);
}

TEST(Path, SpeedChangesWithoutJumpsBetweenWayPoints) {
  const auto path =
      samplePath({point(0, 0, {}, 0.5), point(0, 2, {}, 2.0), point(0, 6, {}, 0.5), point(0, 8)},
                 60.0, "test");
  for (size_t i = 2; i < path.size(); ++i)
    EXPECT_LT(std::abs(stepLength(path, i) - stepLength(path, i - 1)) * 60.0, 0.08);
}

TEST(Path, OnePlaceAtTwoTimesIsAStop) {
  const auto path = samplePath(
      {point(0, 0, 0.0), point(0, 1, 1.0), point(0, 1, 3.0), point(0, 2, 4.0)}, 20.0, "t");
  for (size_t i = 21; i <= 60; ++i) EXPECT_NEAR(stepLength(path, i), 0.0, 1e-9);
  EXPECT_NEAR(path.back().z, 2.0, 1e-9);
}

TEST(Path, FaultsNameTheWayPoint) {
  EXPECT_THROW(samplePath({point(0, 0)}, 20.0, "test"), InputError);
  EXPECT_THROW(samplePath({point(0, 0, {}, -1.0), point(1, 0)}, 20.0, "test"), InputError);
  EXPECT_THROW(samplePath({point(0, 0), point(NAN, 0)}, 20.0, "test"), InputError);
  EXPECT_THROW(samplePath({point(0, 0), point(1, 0)}, 0.0, "test"), InputError);
  EXPECT_THROW(samplePath({point(0, 0), point(0, 0)}, 20.0, "test"), InputError);
  try {
    samplePath({point(0, 0, 0.0), point(1, 0, 2.0), point(2, 0, 1.5)}, 20.0, "route.json");
    FAIL() << "times that fall were accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("route.json"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("way-point 3"), std::string::npos) << e.what();
  }
}

TEST(Path, APathFileIsReadInDegrees) {
  const auto file = temporaryFile("path.json", R"({"waypoints": [{"x": 0, "z": 1, "speed": 1.5},
      {"x": 2, "z": 3, "time": 4, "facing_deg": 90}]})");
  const auto points = readPathFile(file);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].speedMS, 1.5);
  EXPECT_FALSE(points[0].facing.has_value());
  EXPECT_EQ(points[1].timeS, 4.0);
  EXPECT_NEAR(*points[1].facing, kPi / 2.0, 1e-12);
}

TEST(Path, AFixedFacingIsKeptFromWayPointToWayPoint) {
  const auto file =
      temporaryFile("fixed.json", R"({"facing": "fixed", "waypoints": [{"x": 0, "z": 0},
      {"x": 2, "z": 3}, {"x": 2, "z": 5, "facing_deg": 45}, {"x": 4, "z": 5}]})");
  const auto points = readPathFile(file);
  EXPECT_EQ(points[1].facing, 0.0);
  EXPECT_NEAR(*points[3].facing, kPi / 4.0, 1e-12);
}

TEST(Path, ATableIsAPathWhoseColumnsAreNamed) {
  const char* tables[] = {
      "time,x,z,facing_deg\n0,0,1,90\n2,3,4,0\n",
      "# walked\r\nfacing_deg; Z_m; x_m; t\r\n90;1;0;0\r\n0;4;3;2\r\n",
      "\xEF\xBB\xBF\"time_s\"\tx\ty\tz\tfacing_deg\r0\t0\t9\t1\t90\r2\t3\t9\t4\t0"};
  for (const char* table : tables) {
    const auto points = readPathFile(temporaryFile("path.csv", table));
    ASSERT_EQ(points.size(), 2u) << table;
    EXPECT_EQ(points[0].z, 1.0);
    EXPECT_NEAR(*points[0].facing, kPi / 2.0, 1e-12);
    EXPECT_EQ(points[1], (WayPoint{.x = 3, .z = 4, .timeS = 2.0, .speedMS = {}, .facing = 0.0}));
  }
}

/// Two stretches of a metre at a metre a second, and one at half of that.
TEST(Path, TypesHoldFromTheirWayPointOn) {
  const auto points = readPathFile(
      temporaryFile("types.csv", "x,z,speed,type\n0,0,1,walk\n0,1,,\n0,2,0.5,run\n0,3,,jump\n"));
  const auto labels = pathLabels(points, "types.csv");
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0], (LabelSpan{0.0, labels[1].fromS, "walk"}));
  EXPECT_NEAR(labels[1].fromS, 2.0, 1e-9);
  EXPECT_EQ(labels[1].label, "run");
  EXPECT_TRUE(std::isinf(labels[1].toS));
  EXPECT_NE(pathRemarks(points).front().find("'jump'"), std::string::npos);
  const auto again = wayPointsFromJson(toJson(points), "again");
  EXPECT_EQ(again, points);
}

TEST(Path, WhatIsNoPathSaysWhatOneIs) {
  const std::pair<const char*, const char*> wrong[] = {{"hello", "waypoints"},
                                                       {"[[0, 0], [1, 1]]", "waypoints"},
                                                       {"x,y\n0,0\n", "time,x,z"},
                                                       {"", "waypoints"},
                                                       {"HIERARCHY\nROOT a\n", "clip:FILE"},
                                                       {"x,z\n0,0\n1,one\n", ".csv:3"},
                                                       {"x,z\n0,0\n1\n", "2 columns"}};
  for (const auto& [text, expected] : wrong) try {
      readPathFile(temporaryFile("wrong.csv", text));
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
    }
}

TEST(Path, ASpeedThatNoStretchFollowsIsRemarkedOn) {
  const auto at = [](double z, std::optional<double> time, std::optional<double> speed) {
    return WayPoint{.x = 0, .z = z, .timeS = time, .speedMS = speed, .facing = {}};
  };
  EXPECT_TRUE(pathRemarks({at(0, {}, 1.0), at(1, {}, {}), at(2, 9.0, {})}).empty());
  const auto last = pathRemarks({at(0, {}, {}), at(7, {}, 1.4)});
  ASSERT_EQ(last.size(), 1u);
  EXPECT_NE(last[0].find("way-point 2 (1.4 m/s)"), std::string::npos) << last[0];
  // Every stretch that follows has a time of its own.
  EXPECT_EQ(pathRemarks({at(0, 0.0, 1.0), at(1, 2.0, {}), at(2, 4.0, {})}).size(), 1u);
  EXPECT_TRUE(pathRemarks({at(0, 0.0, 1.0), at(1, 2.0, {}), at(2, {}, {})}).empty());
}

TEST(Path, AMisspeltKeyOfAPathFileIsRefused) {
  const auto file = temporaryFile("bad.json", R"({"waypoints": [{"x": 0, "z": 0, "sped": 1}]})");
  try {
    readPathFile(file);
    FAIL() << "a misspelt key was accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("waypoints[0].sped"), std::string::npos) << e.what();
  }
  EXPECT_THROW(readPathFile(temporaryFile("word.json", R"({"waypoints": 3})")), InputError);
  EXPECT_THROW(readPathFile(temporaryFile("way.json", R"({"facing": "up", "waypoints": []})")),
               InputError);
}

TEST(PathPresets, AreTheSyntheticControlOfThePapersAndTwoLoops) {
  std::vector<std::string> names;
  for (const PathPreset& preset : pathPresets()) names.push_back(preset.name);
  const std::vector<std::string> expected = {"still",      "sideways", "slow",
                                             "fast",       "backward", "turn-left",
                                             "turn-right", "circle",   "figure-eight"};
  EXPECT_EQ(names, expected);
}

TEST(PathPresets, HaveTheirSpeedsDirectionsAndTurns) {
  struct Expected {
    const char* name;
    double side, forward, turn;  // per second, in the root frame
  };
  const double turn = 40.0 * kPi / 180.0;
  for (const Expected& e :
       {Expected{"still", 0, 0, 0}, Expected{"sideways", 0.6, 0, 0}, Expected{"slow", 0, 0.7, 0},
        Expected{"fast", 0, 1.9, 0}, Expected{"backward", 0, -0.7, 0},
        Expected{"turn-left", 0, 1.2, turn}, Expected{"turn-right", 0, 1.2, -turn},
        Expected{"circle", 0, 1.2, 0.4}}) {
    const Matrix control = controlFromTrajectory(presetPath(e.name, 4.0, 100.0));
    ASSERT_EQ(control.rows(), 400) << e.name;
    for (int t = 1; t < control.rows(); ++t) {
      // The chord of an arc leaves the tangent by half a step's turn.
      EXPECT_NEAR(control(t, 0) * 100.0, e.side, 0.01) << e.name;
      EXPECT_NEAR(control(t, 1) * 100.0, e.forward, 0.001) << e.name;
      EXPECT_NEAR(control(t, 2) * 100.0, e.turn, 1e-3) << e.name;
    }
  }
}

TEST(PathPresets, TheFigureEightIsWalkedAtConstantSpeedAndCloses) {
  const auto path = presetPath("figure-eight", 30.0, 50.0);
  double nearest = 1e9;
  double turned = 0.0;
  for (size_t i = 1; i < path.size(); ++i) {
    EXPECT_NEAR(stepLength(path, i) * 50.0, 1.2, 0.01);
    turned = std::max(turned, std::abs(path[i].heading));
    if (i > 400)
      nearest = std::min(nearest, std::hypot(path[i].x, path[i].z) +
                                      std::abs(std::remainder(path[i].heading, 2 * kPi)));
  }
  EXPECT_NEAR(path[1].heading, 0.0, 0.05);
  EXPECT_LT(nearest, 0.05);
  // The two loops turn opposite ways.
  EXPECT_LT(turned, 1.6 * kPi);
}

TEST(PathPresets, TheScaleMultipliesTheSpeed) {
  const auto human = presetPath("fast", 2.0, 20.0);
  const auto dog = presetPath("fast", 2.0, 20.0, 0.6);
  ASSERT_EQ(human.size(), dog.size());
  EXPECT_NEAR(dog.back().z, 0.6 * human.back().z, 1e-9);
}

TEST(PathPresets, AnUnknownNameListsTheKnownOnes) {
  try {
    presetPath("zigzag", 1.0, 20.0);
    FAIL() << "an unknown preset was accepted";
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("figure-eight"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace marey

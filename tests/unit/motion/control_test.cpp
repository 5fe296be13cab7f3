// Rows of control against values that are found by hand.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/control/encode_control.h"
#include "motion/walker.h"

namespace marey {
namespace {

constexpr double kFps = 10.0;
constexpr double kPi = std::numbers::pi;
const Place kPlace{.path = "test"};

ControlChannel typeChannel() {
  return {.name = "type",
          .kind = ControlKind::Label,
          .values = {"walk", "run", "step-left", "step-right"},
          .transitionS = 0.4};
}

/// 0.1 m a frame along +Z.
std::vector<RootFrame> straight(int frames) {
  std::vector<RootFrame> out;
  for (int t = 0; t < frames; ++t) out.push_back({2.0, 0.1 * t, 0.0});
  return out;
}

Matrix encoded(const ControlChannel& channel, const ControlRequest& request, int frames = 6) {
  return encodeControl({ControlChannel{}, channel}, straight(frames), request, kFps, kPlace);
}

std::string refusal(const ControlChannel& channel, const ControlRequest& request) {
  try {
    encoded(channel, request);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(Control, RootMotionAloneIsThatOfTheTrajectory) {
  const auto path = straight(5);
  EXPECT_EQ(encodeControl({ControlChannel{}}, path, {}, kFps, kPlace), controlFromTrajectory(path));
}

/// A body that goes along +Z at 1 m/s and faces +X: to its right.
TEST(Control, GroundPointsAheadAreSeenFromTheBody) {
  std::vector<RootFrame> path;
  for (int t = 0; t < 5; ++t) path.push_back({0.0, 0.1 * t, kPi / 2.0});
  const ControlChannel ahead{
      .name = "path", .kind = ControlKind::FuturePath, .aheadS = {0.2, 0.25, 1.0}};
  const Matrix rows = encodeControl({ControlChannel{}, ahead}, path, {}, kFps, kPlace);
  ASSERT_EQ(rows.cols(), 9);
  for (int t = 0; t < 5; ++t) {  // up to the end and beyond
    EXPECT_NEAR(rows(t, 3), -0.2, 1e-6) << t;
    EXPECT_NEAR(rows(t, 4), 0.0, 1e-6) << t;
    EXPECT_NEAR(rows(t, 5), -0.25, 1e-6) << t;
    EXPECT_NEAR(rows(t, 7), -1.0, 1e-5) << t;
  }
}

TEST(Control, AChangeOfLabelGivesWayInItsTime) {
  ControlRequest request;
  request.annotations.labels = {{0.0, 0.2, "walk"}, {.fromS = 0.2, .label = "run"}};
  const Matrix rows = encoded(typeChannel(), request, 8);
  const float walk[] = {1, 1, 1, 0.75F, 0.5F, 0.25F, 0, 0};
  for (int t = 0; t < 8; ++t) {
    EXPECT_NEAR(rows(t, 3), walk[t], 1e-6) << t;
    EXPECT_NEAR(rows(t, 4), 1.F - walk[t], 1e-6) << t;
  }
}

TEST(Control, AGapBetweenLabelsIsTheirTransition) {
  ControlRequest request;
  request.annotations.labels = {{0.0, 0.1, "walk"}, {0.5, 9.0, "run"}};
  const Matrix rows = encoded(typeChannel(), request);
  const float run[] = {0, 0, 0.25F, 0.5F, 0.75F, 1};
  for (int t = 0; t < 6; ++t) EXPECT_NEAR(rows(t, 4), run[t], 1e-6) << t;
}

TEST(Control, WhatIsLeftOutIsZeroAndSaidToBe) {
  ControlChannel type = typeChannel();
  type.optional = true;
  ControlRequest request;
  request.annotations.labels = {{0.2, 0.4, "run"}};
  const Matrix rows = encoded(type, request);
  ASSERT_EQ(rows.cols(), 8);
  const float there[] = {0, 0, 1, 1, 0, 0};
  for (int t = 0; t < 6; ++t) {
    EXPECT_EQ(rows(t, 7), there[t]) << t;
    EXPECT_EQ(rows(t, 4), there[t]) << t;
  }
  request.leftOut = {"type"};
  EXPECT_TRUE(encoded(type, request).rightCols(5).isZero());
  Matrix filled = rows;
  fillAbsent({ControlChannel{}, type}, kFps, {0, 0, 0, 7, 8, 9, 10, 0}, filled);
  EXPECT_EQ(filled(0, 3), 7.F);
  EXPECT_EQ(filled(2, 3), 0.F);
  EXPECT_EQ(filled(0, 7), 0.F);
}

TEST(Control, WhatMustBeThereIsAskedFor) {
  EXPECT_NE(refusal(typeChannel(), {}).find("one of walk, run, step-left, step-right"),
            std::string::npos);
  ControlRequest late;
  late.annotations.labels = {{.fromS = 0.25, .label = "run"}};
  EXPECT_NE(refusal(typeChannel(), late).find("frame 1"), std::string::npos);
  ControlRequest unknown;
  unknown.annotations.labels = {{.label = "dance"}};
  EXPECT_NE(refusal(typeChannel(), unknown).find("'dance'"), std::string::npos);
  ControlRequest crossed;
  crossed.annotations.labels = {{0.0, 0.5, "walk"}, {0.3, 0.9, "run"}};
  EXPECT_NE(refusal(typeChannel(), crossed).find("overlap"), std::string::npos);
  ControlRequest odd;
  odd.annotations.labels = {{.label = "walk"}};
  odd.leftOut = {"speech"};
  EXPECT_NE(refusal(typeChannel(), odd).find("'speech'"), std::string::npos);
}

Signal ramp(double fps, int rows, double startS = 0.0) {
  Signal out{.fps = fps, .startS = startS, .columns = {"left", "right"}, .values = {}};
  for (int i = 0; i < rows; ++i) {
    out.values.push_back(static_cast<float>(i));
    out.values.push_back(static_cast<float>(-i));
  }
  return out;
}

TEST(Control, ASignalIsBroughtToTheRateOfFrames) {
  // 5 rows a second at 10 frames a second: between rows linear; the end goes on.
  const Matrix slow = signalAt(ramp(5.0, 3), 7, kFps);
  for (int t = 0; t < 7; ++t) EXPECT_NEAR(slow(t, 0), std::min(0.5 * t, 2.0), 1e-6) << t;
  // 40 rows a second: the mean of the four from half a frame before to half a frame after.
  const Matrix fast = signalAt(ramp(40.0, 100), 4, kFps);
  for (int t = 1; t < 4; ++t) EXPECT_NEAR(fast(t, 0), 4 * t - 0.5, 1e-5) << t;  // rows 4t-2 .. 4t+1
  // One that begins half a second later.
  EXPECT_NEAR(signalAt(ramp(10.0, 20, 0.5), 8, kFps)(7, 0), 2.0, 1e-6);
}

TEST(Control, ASignalIsSeenAheadAndBack) {
  const ControlChannel speech{.name = "speech",
                              .kind = ControlKind::Array,
                              .values = {"left", "right"},
                              .pastS = 0.1,
                              .futureS = 0.2};
  ControlRequest request;
  request.annotations.signals["speech"] = ramp(10.0, 6);
  const Matrix rows = encoded(speech, request);
  ASSERT_EQ(rows.cols(), 3 + 2 * 4);
  const double seen[] = {1, 2, 3, 4};  // of frame 2: frames 1 .. 4
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(rows(2, 3 + 2 * k), seen[k], 1e-6);
    EXPECT_NEAR(rows(2, 4 + 2 * k), -seen[k], 1e-6);
  }
  request.annotations.signals["speech"].columns = {"one"};
  EXPECT_NE(refusal(speech, request).find("2 columns"), std::string::npos);
}

TEST(Control, TimeMovesWithTheFirstFrame) {
  ControlRequest request;
  request.annotations.labels = {{0.0, 0.3, "walk"}, {.fromS = 0.3, .label = "run"}};
  request.annotations.signals["speech"] = ramp(10.0, 20);
  const auto later = startingAt(request.annotations, 0.2);
  const Matrix all = labelWeights(typeChannel(), request.annotations.labels, 9, kFps, kPlace);
  EXPECT_TRUE(labelWeights(typeChannel(), later.labels, 7, kFps, kPlace)
                  .isApprox(all.bottomRows(7), 1e-6F));
  EXPECT_TRUE(signalAt(later.signals.at("speech"), 7, kFps)
                  .isApprox(signalAt(ramp(10.0, 20), 9, kFps).bottomRows(7), 1e-5F));
}

TEST(Control, ABodyIsItsRestPose) {
  Skeleton s{.names = {"Hips", "LeftLeg", "LeftFoot", "RightLeg"},
             .parents = {-1, 0, 1, 0},
             .offsets = {{5, 5, 5}, {0.1F, -0.4F, 0}, {0, -0.5F, 0}, {-0.1F, -0.4F, 0}},
             .endSites = {}};
  // The leg turned by a right angle about +Z: its foot lies at +X of the knee.
  s.rest.assign(4, Eigen::Quaternionf::Identity());
  s.rest[1] = Eigen::AngleAxisf(static_cast<float>(kPi / 2), Eigen::Vector3f::UnitZ());
  const auto values = restPoseControl(s);
  const float expected[] = {0, 0, 0, 0.1F, -0.4F, 0, 0.6F, -0.4F, 0, -0.1F, -0.4F, 0, 0.4F};
  ASSERT_EQ(values.size(), 13U);
  for (size_t i = 0; i < 13; ++i) EXPECT_NEAR(values[i], expected[i], 1e-6) << i;
}

TEST(Control, LabelsAreFoundInNames) {
  ControlChannel type = typeChannel();
  type.values = {"walk", "walk-back", "turn", "run"};
  EXPECT_EQ(labelInName(type, "actor3_walk_001"), "walk");
  EXPECT_EQ(labelInName(type, "actor3_walk-back_001"), "walk-back");
  EXPECT_EQ(labelInName(type, "Run2"), "run");
  EXPECT_EQ(labelInName(type, "return_07"), "");
}

ControlLayout everything() {
  return {
      ControlChannel{},
      {.name = "path", .kind = ControlKind::FuturePath, .optional = true, .aheadS = {0.3}},
      typeChannel(),
      {.name = "body", .kind = ControlKind::Skeleton, .joints = walkerSkeleton()->jointCount()},
      {.name = "speech", .kind = ControlKind::Array, .values = {"left", "right"}, .futureS = 0.2}};
}

FeatureSpec specOf(const ControlLayout& layout) {
  FeatureSpec out{.fps = kFps};
  out.control = layout;
  return out;
}

FeatureSequence walked() {
  std::vector<RootFrame> path;
  for (int t = 0; t < 30; ++t) path.push_back({0.02 * t, 0.1 * t, 0.05 * t});
  Clip clip = walk(path, {.seed = 3, .fps = kFps}).clip;
  clip.annotations.labels = {{0.0, 1.0, "step-left"}, {.fromS = 1.0, .label = "walk"}};
  clip.annotations.signals["speech"] = ramp(10.0, 30);
  return extractFeatures(clip, specOf(everything()));
}

TEST(Control, MirroringSwapsSidesAndIsItsOwnInverse) {
  const auto f = walked();
  const auto skeleton = walkerSkeleton();
  const Matrix once = mirroredControl(everything(), kFps, f.control, *skeleton);
  const auto at = columnsOf(everything(), kFps);
  EXPECT_EQ(once(3, 0), -f.control(3, 0));
  EXPECT_EQ(once(3, 1), f.control(3, 1));
  EXPECT_EQ(once(3, at[1].first), -f.control(3, at[1].first));
  EXPECT_EQ(once(3, at[1].first + 1), f.control(3, at[1].first + 1));
  EXPECT_EQ(once(3, at[2].first + 3), 1.F) << "a step to the right";
  EXPECT_EQ(once(3, at[4].first), f.control(3, at[4].first + 1)) << "left has right's signal";
  const int left = skeleton->find("LeftUpLeg"), right = skeleton->find("RightUpLeg");
  EXPECT_EQ(once(0, at[3].first + 3 * left), -f.control(0, at[3].first + 3 * right));
  EXPECT_TRUE(mirroredControl(everything(), kFps, once, *skeleton) == f.control);
}

TEST(Control, BackwardsInTimeWhatWasAheadIsPast) {
  const FeatureSpec spec = specOf(everything());
  const auto f = walked();
  const auto back = timeReversed(f, spec);
  const auto at = columnsOf(everything(), kFps);
  const long last = f.control.rows() - 1;
  EXPECT_TRUE(back.control.middleCols(at[2].first, 4).row(0) ==
              f.control.middleCols(at[2].first, 4).row(last));
  // Ahead of reversed frame 5 lie the frames before frame last - 5.
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(back.control(5, at[4].first + 2 * k), f.control(last - 5 - k, at[4].first));
  // The way ahead leads to where the body came from.
  const auto way = trajectoryFromControl(f.control, f.start);
  const RootFrame from = way[static_cast<size_t>(last - 5)],
                  to = way[static_cast<size_t>(last - 8)];
  const double dx = to.x - from.x, dz = to.z - from.z;
  EXPECT_NEAR(back.control(5, at[1].first),
              std::cos(from.heading) * dx - std::sin(from.heading) * dz, 1e-4);
}

}  // namespace
}  // namespace marey

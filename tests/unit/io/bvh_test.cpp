#include "io/bvh.h"

#include <cmath>
#include <numbers>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "motion/kinematics.h"
#include "motion/rotation.h"

namespace marey::io {
namespace {

using test::expectContains;
using test::hasNote;
using test::inputErrorOf;
using test::with;

/// Root, an arm with another order of turns, a hand with six channels; metres.
const std::string kSmall =
    "HIERARCHY\n"
    "ROOT Hips\n{\n  OFFSET 0 0 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT Arm\n  {\n    OFFSET 0 1 0\n    CHANNELS 3 Yrotation Zrotation Xrotation\n"
    "    JOINT Hand\n    {\n      OFFSET 0 0.5 0\n"
    "      CHANNELS 6 Xrotation Yrotation Zrotation Zposition Yposition Xposition\n"
    "      End Site\n      {\n        OFFSET 0 0.25 0\n      }\n    }\n  }\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.05\n"
    "1 2 3 90 0 0 0 0 0 0 0 0 0 0.5 0\n"
    "4 5 6 10 20 30 40 50 60 70 80 90 0.1 0.2 0.3\n";

const ReadOptions kMetres{.unit = "m"};

Clip parse(const std::string& text, const ReadOptions& options = kMetres) {
  return parseBvh(text, "small.bvh", options);
}

Eigen::Matrix3d turn(int axis, double degrees) {
  const double a = degrees * std::numbers::pi / 180.0, c = std::cos(a), s = std::sin(a);
  Eigen::Matrix3d m;
  if (axis == 0) m << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 1) m << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 2) m << c, -s, 0, s, c, 0, 0, 0, 1;
  return m;
}

TEST(BvhReader, AQuarterTurnAboutZLaysTheBodyAlongMinusX) {
  const Clip clip = parse(kSmall);
  ASSERT_EQ(clip.frameCount(), 2);
  EXPECT_EQ(clip.fps, 20.0);
  EXPECT_LT((clip.at(0, 0) - Vec3(1, 2, 3)).norm(), 1e-6f);
  EXPECT_LT((clip.at(0, 1) - Vec3(0, 2, 3)).norm(), 1e-6f);
  EXPECT_LT((clip.at(0, 2) - Vec3(-0.5f, 2, 3)).norm(), 1e-6f);
}

TEST(BvhReader, ChannelsTurnInTheirOwnOrderPerJointAndPositionsReplaceOffsets) {
  const Clip clip = parse(kSmall);
  const Eigen::Matrix3d hips = turn(2, 10) * turn(0, 20) * turn(1, 30);
  const Eigen::Matrix3d arm = hips * turn(1, 40) * turn(2, 50) * turn(0, 60);
  const Eigen::Matrix3d hand = arm * turn(0, 70) * turn(1, 80) * turn(2, 90);
  const Vec3d armAt = Vec3d(4, 5, 6) + hips * Vec3d(0, 1, 0);
  const Vec3d handAt = armAt + arm * Vec3d(0.3, 0.2, 0.1);
  EXPECT_LT((clip.at(1, 1).cast<double>() - armAt).norm(), 1e-5);
  EXPECT_LT((clip.at(1, 2).cast<double>() - handAt).norm(), 1e-5);
  const std::vector<Quat> turned = globalRotations(*clip.skeleton, *clip.transforms);
  EXPECT_LT((turned[5].cast<double>().toRotationMatrix() - hand).norm(), 1e-5);
  ASSERT_EQ(clip.skeleton->endSites.size(), 1U);
  EXPECT_LT((clip.skeleton->endSites[0].offset - Vec3(0, 0.25f, 0)).norm(), 1e-6f);
  EXPECT_EQ(clip.source.eulerOrders, (std::vector<std::string>{"ZXY", "YZX", "XYZ"}));
}

TEST(BvhReader, AGivenEulerOrderReplacesThatOfTheFileAndValuesKeepTheirAxes) {
  const Clip clip = parse(kSmall, {.unit = "m", .eulerOrder = "yxz"});
  const Eigen::Matrix3d hips = turn(1, 30) * turn(0, 20) * turn(2, 10);
  const Eigen::Matrix3d arm = hips * turn(1, 40) * turn(0, 60) * turn(2, 50);
  const Vec3d armAt = Vec3d(4, 5, 6) + hips * Vec3d(0, 1, 0);
  const Vec3d handAt = armAt + arm * Vec3d(0.3, 0.2, 0.1);
  EXPECT_LT((clip.at(1, 1).cast<double>() - armAt).norm(), 1e-5);
  EXPECT_LT((clip.at(1, 2).cast<double>() - handAt).norm(), 1e-5);
  EXPECT_EQ(clip.source.eulerOrders, (std::vector<std::string>{"YXZ", "YXZ", "YXZ"}));
  EXPECT_TRUE(hasNote(clip, "as given"));
}

TEST(BvhReader, AJointThatTurnsTwiceAboutOneAxisKeepsItsOrder) {
  const std::string twice =
      with(kSmall, "3 Yrotation Zrotation Xrotation", "3 Zrotation Xrotation Zrotation");
  EXPECT_EQ(parse(twice, {.unit = "m", .eulerOrder = "YXZ"}).source.eulerOrders,
            (std::vector<std::string>{"YXZ", "ZXZ", "YXZ"}));
  for (const char* wrong : {"XY", "XYX", "XYZZ", "abc"})
    EXPECT_THROW(parse(kSmall, {.unit = "m", .eulerOrder = wrong}), UsageError) << wrong;
}

TEST(BvhReader, LineEndsTabsCaseAndAMissingLastNewlineDoNotMatter) {
  std::string odd;
  for (const char c : with(kSmall, "End Site", "End site")) {
    if (c == '\n') odd += '\r';
    odd += c == ' ' ? '\t' : c;
  }
  odd = with(with(odd, "Frame\tTime:\t", "Frame Time:\t"), "End\tsite", "End site");
  odd.resize(odd.size() - 2);
  EXPECT_EQ(parse(odd).positions, parse(kSmall).positions);
}

TEST(BvhReader, BracesMayStandOnTheLineOfTheName) {
  const std::string text =
      with(with(kSmall, "JOINT Arm\n  {", "JOINT Arm {"), "End Site\n      {", "End Site {");
  EXPECT_EQ(parse(text).positions, parse(kSmall).positions);
}

TEST(BvhReader, RoundedFrameTimesAreSnappedToTheRateTheyStandForAndNoted) {
  const std::pair<const char*, double> cases[] = {
      {"0.033333", 30.0}, {"0.0333", 30.0},    {"0.016667", 60.0},
      {"0.01667", 60.0},  {".0083333", 120.0}, {"0.008333", 120.0},
      {"0.0083", 120.0},  {"0.041667", 24.0},  {"0.0333667", 30.0 / 1.001}};
  for (const auto& [time, fps] : cases) {
    const SnappedRate rate = rateOfFrameTime(time);
    EXPECT_DOUBLE_EQ(rate.fps, fps) << time;
    EXPECT_TRUE(rate.snapped) << time;
  }
  EXPECT_TRUE(hasNote(parse(with(kSmall, "0.05", "0.016667")), "1/60 s"));
}

TEST(BvhReader, ExactAndUnusualFrameTimesAreTakenAsTheyAre) {
  for (const auto& [time, fps] : {std::pair{"0.05", 20.0},
                                  {"0.008", 125.0},
                                  {"0.04", 25.0},
                                  {"1", 1.0},
                                  {"0.033333333333333", 30.0}}) {
    EXPECT_NEAR(rateOfFrameTime(time).fps, fps, 1e-9) << time;
    EXPECT_FALSE(rateOfFrameTime(time).snapped) << time;
  }
  EXPECT_NEAR(rateOfFrameTime("0.0345").fps, 1.0 / 0.0345, 1e-9);
  EXPECT_FALSE(rateOfFrameTime("0.0345").snapped);
}

TEST(BvhReader, RepeatedNamesAreNumberedAndNoted) {
  const Clip clip = parse(with(kSmall, "JOINT Hand", "JOINT Arm"));
  EXPECT_EQ(clip.skeleton->names, (std::vector<std::string>{"Hips", "Arm", "Arm_2"}));
  EXPECT_TRUE(hasNote(clip, "Arm_2"));
}

TEST(BvhReader, OptionsReplaceUnitUpAxisAndRate) {
  const Clip clip = parse(kSmall, {.unit = "cm", .up = "z", .fps = 50.0});
  EXPECT_EQ(clip.fps, 50.0);
  EXPECT_LT((clip.at(0, 0) - Vec3(0.01f, 0.03f, -0.02f)).norm(), 1e-7f);
  EXPECT_EQ(clip.source.unit, "cm");
  // The transforms say the same as the positions.
  const std::vector<Vec3> again = forwardKinematics(*clip.skeleton, *clip.transforms);
  for (size_t i = 0; i < again.size(); ++i) EXPECT_LT((again[i] - clip.positions[i]).norm(), 1e-6f);
}

std::string person(double scale) {
  const auto offset = [scale](double x, double y, double z) {
    return fmt::format("{{\nOFFSET {} {} {}\nCHANNELS 3 Zrotation Xrotation Yrotation\n", x * scale,
                       y * scale, z * scale);
  };
  std::string out = "HIERARCHY\nROOT Hips\n" + offset(0, 0, 0);
  for (const char* side : {"Left", "Right"}) {
    const double x = side[0] == 'L' ? 0.1 : -0.1;
    out += fmt::format("JOINT {}UpLeg\n", side) + offset(x, 0, 0) +
           fmt::format("JOINT {}Leg\n", side) + offset(0, -0.41, 0) +
           fmt::format("JOINT {}Foot\n", side) + offset(0, -0.42, 0) + "}\n}\n}\n";
  }
  return out + "JOINT Spine\n" + offset(0, 0.3, 0) + "JOINT Head\n" + offset(0, 0.25, 0) +
         "}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.05\n" +
         "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
}

TEST(BvhReader, TheUnitIsGuessedSoThatAPersonHasThePersonsSize) {
  const std::pair<double, const char*> cases[] = {
      {1.0, "m"}, {100.0, "cm"}, {1000.0, "mm"}, {1.0 / 0.0254, "inch"}, {0.45 / 0.0254, "cmu"}};
  for (const auto& [scale, unit] : cases) {
    const Clip clip = parse(person(scale), {});
    EXPECT_EQ(clip.source.unit, unit);
    EXPECT_NEAR((clip.at(0, 3) - clip.at(0, 1)).norm(), 0.83f, 1e-4f) << unit;
    EXPECT_TRUE(hasNote(clip, "unit " + std::string(unit) + " is a guess")) << unit;
  }
  EXPECT_TRUE(hasNote(parse(person(5.0), {}), "an uncertain guess"));
}

TEST(BvhReader, ARootThatMarksThePlaceOnTheFloorIsLeftOutAndItsMotionKept) {
  const std::string text =
      "HIERARCHY\nROOT joint_Root\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
      "Zrotation Xrotation Yrotation\n"
      "JOINT Hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
      "JOINT Spine\n{\nOFFSET 0 0 1\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n}\n}\n"
      "MOTION\nFrames: 2\nFrame Time: 0.05\n0 0 0 0 0 0 0 0 0 0 0 0\n2 0 3 0 0 90 0 0 0 0 0 0\n";
  const Clip clip = parse(text);
  ASSERT_EQ(clip.skeleton->names, (std::vector<std::string>{"Hips", "Spine"}));
  EXPECT_LT((clip.at(1, 0) - Vec3(2, 1, 3)).norm(), 1e-6f);
  EXPECT_LT((clip.at(1, 1) - Vec3(3, 1, 3)).norm(), 1e-6f);
  const std::vector<Vec3> again = forwardKinematics(*clip.skeleton, *clip.transforms);
  EXPECT_LT((again[3] - Vec3(3, 1, 3)).norm(), 1e-6f);
  EXPECT_TRUE(hasNote(clip, "joint_Root"));
  EXPECT_EQ(parse(text, {.unit = "m", .dropStaticRoot = false}).jointCount(), 3);
}

TEST(BvhReader, ARowOfTheWrongLengthIsNamedByLineAndFrame) {
  const std::string three =
      with(kSmall, "Frames: 2", "Frames: 3") + "4 5 6 10 20 30 40 50 60 70 80 90 0.1 0.2 0.3\n";
  for (const auto& [row, found] :
       {std::pair{"0.1 0.2\n", "found 14"}, {"0.1 0.2 0.3 7\n", "found 16"}}) {
    const std::string text = with(three, "0.1 0.2 0.3\n", row);
    const std::string message = inputErrorOf([&] { parse(text); });
    expectContains(message, "small.bvh:25, frame 2");
    expectContains(message, "expected 15 numbers");
    expectContains(message, found);
  }
}

TEST(BvhReader, WhatIsNoNumberIsNamedByLineAndFrame) {
  for (const char* bad : {"nan", "inf", "abc", "1e400"}) {
    const std::string message =
        inputErrorOf([&] { parse(with(kSmall, "40 50", std::string("40 ") + bad)); });
    expectContains(message, "small.bvh:25, frame 2");
    expectContains(message, bad);
  }
}

TEST(BvhReader, ATruncatedFileSaysHowManyFramesItHolds) {
  const std::string message = inputErrorOf([] { parse(with(kSmall, "Frames: 2", "Frames: 4")); });
  expectContains(message, "4 frames");
  expectContains(message, "after 2");
}

TEST(BvhReader, ABillionPromisedFramesTakeNoMemory) {
  const std::string message =
      inputErrorOf([] { parse(with(kSmall, "Frames: 2", "Frames: 1000000000")); });
  expectContains(message, "expected 1000000000 frames");
}

TEST(BvhReader, HeadersThatMakeNoMotionAreRefused) {
  const std::pair<const char*, const char*> broken[][1] = {
      {{"Frames: 2", "Frames: 0"}},
      {{"Frames: 2", "Frames: -1"}},
      {{"Frames: 2", "Frames: two"}},
      {{"Frame Time: 0.05", "Frame Time: 0"}},
      {{"Frame Time: 0.05", "Frame Time: -1"}},
      {{"Frame Time: 0.05", "Frame Time: nan"}},
      {{"Frame Time: 0.05", "Time: 1"}},
      {{"HIERARCHY", "HIERARCHIE"}},
      {{"Zrotation Xrotation", "Wrotation Xrotation"}},
      {{"CHANNELS 6 X", "CHANNELS 7 X"}},
      {{"CHANNELS 6 X", "CHANNELS -6 X"}},
      {{"JOINT Arm", "ROOT Arm"}},
      {{"JOINT Arm", "JOINT"}},
      {{"OFFSET 0 1 0", "OFFSET 0 1"}},
      {{"OFFSET 0 1 0", "OFFSET 0 nan 0"}},
      {{"MOTION", "}"}},
      {{"MOTION", "ROOT Other\n{\n}\nMOTION"}},
      {{"ROOT Hips\n{", "ROOT Hips\n"}},
      {{"End Site", "End"}},
      {{"\n  OFFSET 0 0 0", "\n  OFFSIDE 0 0 0"}}};
  for (const auto& change : broken)
    expectContains(inputErrorOf([&] { parse(with(kSmall, change[0].first, change[0].second)); }),
                   "small.bvh:");
}

TEST(BvhReader, AFileThatEndsAnywhereInTheHierarchyIsRefused) {
  const size_t motion = kSmall.find("Frame Time");
  for (size_t cut = 0; cut < motion; cut += 7)
    EXPECT_THROW(parse(kSmall.substr(0, cut)), InputError) << cut;
}

TEST(BvhReader, AnUnknownChannelIsNamed) {
  expectContains(inputErrorOf([] {
                   parse(with(kSmall, "Xrotation Yrotation\n  JOINT", "Xscale Yrotation\n  JOINT"));
                 }),
                 "'Xscale'");
}

TEST(Formats, ContentAndNotTheNameDecides) {
  const test::TemporaryFolder folder;
  writeFileAtomically(folder / "motion.dat", kSmall);
  EXPECT_EQ(readClip(folder / "motion.dat", kMetres).frameCount(), 2);
  writeFileAtomically(folder / "motion.bvh", "no motion");
  expectContains(inputErrorOf([&] { readClip(folder / "motion.bvh"); }), "'no motion'");
  writeFileAtomically(folder / "empty.bvh", "");
  expectContains(inputErrorOf([&] { readClip(folder / "empty.bvh"); }), "an empty file");
  EXPECT_THROW(readClip(folder / "missing.bvh"), FileError);
}

TEST(Formats, UnknownUnitsAndFormatsNameTheKnownOnes) {
  try {
    parse(kSmall, {.unit = "ell"});
    FAIL();
  } catch (const UsageError& e) {
    expectContains(e.what(), "cmu");
  }
  EXPECT_THROW(parse(kSmall, {.up = "x"}), UsageError);
  EXPECT_THROW(formatByName("fbx"), UsageError);
  EXPECT_THROW(writeClip(parse(kSmall), "out.amc"), UsageError);
  EXPECT_THROW(writeClip(parse(kSmall), "out.bvh", {.format = "amc"}), UsageError);
}

}  // namespace
}  // namespace marey::io

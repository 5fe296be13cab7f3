#include "io/asf_amc.h"

#include <cmath>
#include <numbers>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "io/clip_io.h"

namespace marey::io {
namespace {

using test::expectContains;
using test::inputErrorOf;
using test::with;

const std::string kAsf =
    "# a comment\n:version 1.10\n:name VICON\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
    ":documentation\n  begin of no bone\n:root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n"
    "  position 0 0 0\n  orientation 0 0 0\n:bonedata\n"
    "  begin\n    id 1\n    name thigh\n    direction 0 -1 0\n    length 8\n    axis 0 0 20 XYZ\n"
    "    dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n           (-60.0 "
    "70.0)\n  end\n"
    "  begin\n    id 2\n    name shin\n    direction 0 -3 0\n    length 7\n    axis 90 0 90 XYZ\n  "
    "  dof rx\n  end\n"
    "  begin\n    id 3\n    name chest\n    direction 0 1 0\n    length 5\n    axis 0 0 0 XYZ\n  "
    "end\n"
    ":hierarchy\n  begin\n    root chest thigh\n    thigh shin\n  end\n";
const std::string kAmc =
    "#!OML:ASF somewhere\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nthigh 0 0 0\nshin 0\n"
    "2\nroot 1 2 3 10 20 30\nthigh 40 50 60\nshin 70\n";
constexpr double kUnitM = 0.0254 / 0.45;

Clip parse(const std::string& amc, const std::string& asf = kAsf) {
  return parseAmc(amc, "a.amc", parseAsf(asf, "a.asf"));
}

Eigen::Matrix3d turn(int axis, double degrees) {
  const double a = degrees * std::numbers::pi / 180.0, c = std::cos(a), s = std::sin(a);
  Eigen::Matrix3d m;
  if (axis == 0) m << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 1) m << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 2) m << c, -s, 0, s, c, 0, 0, 0, 1;
  return m;
}

TEST(AsfAmc, TheRestPoseIsTheDirectionsTimesLengthsInInchesOver45Hundredths) {
  const Clip clip = parse(kAmc);
  EXPECT_EQ(clip.skeleton->names, (std::vector<std::string>{"root", "chest", "thigh", "shin"}));
  const Vec3d root = Vec3d(1, 2, 3) * kUnitM;
  EXPECT_LT((clip.at(0, 0).cast<double>() - root).norm(), 1e-6);
  EXPECT_LT((clip.at(0, 2).cast<double>() - root).norm(), 1e-6)
      << "a joint is where its bone begins";
  EXPECT_LT((clip.at(0, 3).cast<double>() - root - Vec3d(0, -8 * kUnitM, 0)).norm(), 1e-6);
  EXPECT_EQ(clip.skeleton->endSites.size(), 2u);
  EXPECT_NEAR(clip.skeleton->endSites[1].offset.y(), -7 * kUnitM, 1e-6);
  EXPECT_EQ(clip.source.unit, "cmu");
  EXPECT_TRUE(test::hasNote(clip, "120"));
}

TEST(AsfAmc, TurnsAreConjugatedByTheBonesAxisAndAppliedInTheOrderListed) {
  const Clip clip = parse(kAmc);
  const Eigen::Matrix3d root = turn(2, 30) * turn(1, 20) * turn(0, 10);
  const Eigen::Matrix3d axis = turn(2, 20);
  const Eigen::Matrix3d thigh =
      root * axis * turn(2, 60) * turn(1, 50) * turn(0, 40) * axis.transpose();
  const Vec3d knee = Vec3d(1, 2, 3) * kUnitM + thigh * Vec3d(0, -8 * kUnitM, 0);
  EXPECT_LT((clip.at(1, 3).cast<double>() - knee).norm(), 1e-6);
  const Eigen::Matrix3d shinAxis = turn(2, 90) * turn(0, 90);
  const Eigen::Matrix3d shin = shinAxis * turn(0, 70) * shinAxis.transpose();
  EXPECT_LT((clip.transforms->rotations[7].toRotationMatrix().cast<double>() - shin).norm(), 1e-5);
  EXPECT_EQ(clip.source.eulerOrders, (std::vector<std::string>{"ZYX", "", "ZYX", "X"}));
}

TEST(AsfAmc, AGivenEulerOrderReplacesThatOfTheSkeleton) {
  const Clip clip = parseAmc(kAmc, "a.amc", parseAsf(kAsf, "a.asf"), {.eulerOrder = "XZY"});
  const Eigen::Matrix3d root = turn(0, 10) * turn(2, 30) * turn(1, 20);
  const Eigen::Matrix3d axis = turn(2, 20);
  const Eigen::Matrix3d thigh =
      root * axis * turn(0, 40) * turn(2, 60) * turn(1, 50) * axis.transpose();
  const Vec3d knee = Vec3d(1, 2, 3) * kUnitM + thigh * Vec3d(0, -8 * kUnitM, 0);
  EXPECT_LT((clip.at(1, 3).cast<double>() - knee).norm(), 1e-6);
  EXPECT_EQ(clip.source.eulerOrders, (std::vector<std::string>{"XZY", "", "XZY", "X"}));
}

TEST(AsfAmc, RadiansAndOtherLengthUnitsAreHonoured) {
  const std::string radians =
      ":FULLY-SPECIFIED\n:RADIANS\n1\nroot 1 2 3 0.1745329252 0.3490658504 0.5235987756\n"
      "thigh 0.6981317008 0.872664626 1.0471975512\nshin 1.2217304764\n";
  const Clip a = parse(kAmc), b = parse(radians);
  for (int j = 0; j < 4; ++j) EXPECT_LT((a.at(1, j) - b.at(0, j)).norm(), 1e-6f);
  const Clip inches = parse(kAmc, with(kAsf, "length 0.45", "length 1"));
  EXPECT_NEAR(inches.at(0, 0).x(), 0.0254, 1e-7);
}

TEST(AsfAmc, BadMotionIsNamedByLine) {
  const std::pair<const char*, std::pair<const char*, const char*>> cases[] = {
      {"a.amc:6", {"thigh 0 0 0", "thigh 0 0"}},
      {"a.amc:6", {"thigh 0 0 0", "thigh 0 0 0 0"}},
      {"a.amc:6", {"thigh 0 0 0", "thigh 0 nan 0"}},
      {"a.amc:6", {"thigh 0 0 0", "thumb 0 0 0"}},
      {"a.amc:6", {"thigh 0 0 0", "root 1 2 3 0 0 0"}},
      {"a.amc:7", {"shin 0\n2", "2"}},
      {"a.amc:8", {"\n2\n", "\n3\n"}},
      {"a.amc:4", {"1\nroot", "root"}},
  };
  for (const auto& [place, change] : cases)
    expectContains(inputErrorOf([&] { parse(with(kAmc, change.first, change.second)); }), place);
  expectContains(inputErrorOf([] { parse(":FULLY-SPECIFIED\n:DEGREES\n"); }), "zero frames");
  expectContains(inputErrorOf([] { parse(kAmc.substr(0, kAmc.rfind("shin"))); }), "bone 'shin'");
}

TEST(AsfAmc, BadSkeletonsAreNamedByLine) {
  const std::pair<const char*, const char*> changes[] = {{"length 0.45", "length 0"},
                                                         {"angle deg", "angle gon"},
                                                         {"dof rx ry rz", "dof rx ry rw"},
                                                         {"thigh shin", "thigh foot"},
                                                         {"thigh shin", "thigh chest"},
                                                         {"root chest thigh", "hip chest thigh"},
                                                         {"name shin", "name thigh"},
                                                         {"axis 0 0 20 XYZ", "axis 0 0 20 XXX"},
                                                         {"direction 0 -1 0", "direction 0 x 0"},
                                                         {"order TX", "order QX"}};
  for (const auto& [from, to] : changes)
    expectContains(inputErrorOf([&, f = from, t = to] { parse(kAmc, with(kAsf, f, t)); }),
                   "a.asf:");
  EXPECT_THROW(parseAsf("", "a.asf"), InputError);
  EXPECT_THROW(parseAsf(kAsf.substr(0, kAsf.find(":hierarchy")), "a.asf"), InputError);
}

TEST(AsfAmc, TheSkeletonIsTheAsfWithTheLongestCommonBeginning) {
  const test::TemporaryFolder folder;
  for (const char* name : {"0.asf", "01.asf", "11.asf"}) writeFileAtomically(folder / name, kAsf);
  writeFileAtomically(folder / "01_01.amc", kAmc);
  EXPECT_EQ(asfBeside(folder / "01_01.amc").filename(), "01.asf");
  EXPECT_EQ(asfBeside(folder / "11_07.amc").filename(), "11.asf");
  expectContains(inputErrorOf([&] { asfBeside(folder / "x.amc"); }), "none with a similar name");
  const Clip clip = readClip(folder / "01_01.amc");
  EXPECT_EQ(clip.frameCount(), 2);
  EXPECT_TRUE(test::hasNote(clip, "skeleton from 01.asf"));
  EXPECT_EQ(readClip(folder / "01_01.amc", {.asf = folder / "11.asf"}).frameCount(), 2);
}

TEST(AsfAmc, AnAmcWithoutAnySkeletonSaysWhatIsMissing) {
  const test::TemporaryFolder folder;
  writeFileAtomically(folder / "01_01.amc", kAmc);
  expectContains(inputErrorOf([&] { readClip(folder / "01_01.amc"); }), "no ASF file");
}

}  // namespace
}  // namespace marey::io

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/clip_io.h"
#include "io/dog_text.h"
#include "io/text.h"
#include "motion/kinematics.h"

namespace marey::io {
namespace {

using test::expectContains;
using test::inputErrorOf;

std::string dogRow(int numbers, double first) {
  std::string out;
  for (int i = 0; i < numbers; ++i) out += fmt::format("{}{:.5f}", i == 0 ? "" : ",\t", first + i);
  return out + "\n";
}

TEST(DogText, JointsAreTriplesInMetresAt60Fps) {
  const Clip clip = parseDogText(dogRow(81, 0.0) + dogRow(81, 100.0), "dog.txt");
  EXPECT_EQ(clip.frameCount(), 2);
  EXPECT_EQ(clip.fps, 60.0);
  EXPECT_EQ(clip.at(1, 26), Vec3(178, 179, 180));
  EXPECT_EQ(clip.skeleton->names[26], "Tail1Site");
  EXPECT_EQ(clip.skeleton->parents[25], 24);
}

TEST(DogText, BadRowsAreNamedByLine) {
  expectContains(inputErrorOf([] { parseDogText(dogRow(81, 0) + dogRow(80, 0), "d.txt"); }),
                 "d.txt:2");
  expectContains(inputErrorOf([] { parseDogText(dogRow(81, 0) + dogRow(84, 0), "d.txt"); }),
                 "found 84");
  expectContains(
      inputErrorOf([] { parseDogText(test::with(dogRow(81, 0), "5.00000", "nan"), "d.txt"); }),
      "'nan'");
  expectContains(inputErrorOf([] { parseDogText("\n\n", "d.txt"); }), "zero frames");
}

TEST(DogText, OnlyRowsOf81CommaSeparatedNumbersAreTakenForIt) {
  EXPECT_GT(canReadDogText(dogRow(81, 0) + dogRow(81, 0)), 0);
  EXPECT_EQ(canReadDogText(dogRow(80, 0)), 0);
  EXPECT_EQ(canReadDogText("a.bvh\nb.bvh\n"), 0);
  EXPECT_EQ(canReadDogText(""), 0);
}

Clip twoJoints() {
  Skeleton s;
  s.names = {"Hips", "Head, \"top\""};
  s.parents = {-1, 0};
  s.offsets = {Vec3::Zero(), Vec3(0, 1, 0)};
  Clip clip;
  clip.name = "two";
  clip.skeleton = std::make_shared<const Skeleton>(s);
  clip.fps = 20.0;
  clip.positions = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(0.5f, -0.25f, 0), Vec3(7, 8, 9)};
  return clip;
}

TEST(Csv, LongHasARowPerFrameAndJoint) {
  const test::TemporaryFolder folder;
  writeClip(twoJoints(), folder / "a.csv");
  EXPECT_EQ(readFile(folder / "a.csv"),
            "frame,time_s,joint,x_m,y_m,z_m\n"
            "0,0,Hips,1,2,3\n0,0,\"Head, \"\"top\"\"\",4,5,6\n"
            "1,0.05,Hips,0.5,-0.25,0\n1,0.05,\"Head, \"\"top\"\"\",7,8,9\n");
}

TEST(Csv, WideHasTimeFirstAndARowPerFrame) {
  const test::TemporaryFolder folder;
  const auto written =
      writeClip(twoJoints(), folder / "a.csv", {.format = "csv-wide", .recipe = {{"seed", 1}}})
          .files;
  const std::string text = readFile(folder / "a.csv");
  expectContains(
      text, "time,Hips_Xposition,Hips_Yposition,Hips_Zposition,\"Head, \"\"top\"\"_Xposition\"");
  expectContains(text, "\n0.05,0.5,-0.25,0,7,8,9\n");
  const Json record = readJson(written.at(1));
  EXPECT_EQ(record["export"]["unit"], "m");
  EXPECT_EQ(record["seed"], 1);
}

TEST(Csv, UnitAndUpAxisAreTheOnesAskedFor) {
  const test::TemporaryFolder folder;
  writeClip(twoJoints(), folder / "a.csv", {.unit = "cm", .up = "z"});
  const std::string text = readFile(folder / "a.csv");
  expectContains(text, "x_cm,y_cm,z_cm");
  expectContains(text, "0,0,Hips,100,-300,200\n");
}

}  // namespace
}  // namespace marey::io

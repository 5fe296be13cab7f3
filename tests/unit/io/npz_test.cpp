#include <cmath>
#include <cstring>

#include "unit/io/support.h"

#include "base/archive.h"
#include "base/npy.h"
#include "io/clip_io.h"
#include "io/known_skeletons.h"
#include "io/npz_clips.h"
#include "motion/kinematics.h"
#include "motion/roles.h"

namespace marey::io {
namespace {

using test::expectContains;
using test::inputErrorOf;
using Arrays = NpzArrays;

/// One clip whose joint 0 is at (0, 1, 0) and joint 1 at (1, 1, 0) of the body's frame.
Arrays fieldArrays(const std::vector<std::array<float, 3>>& controls) {
  std::vector<float> values;
  for (const auto& control : controls) {
    std::vector<float> row(63, 0.0f);
    for (size_t j = 0; j < 21; ++j) row[3 * j + 1] = 1.0f;
    row[3] = 1.0f;
    values.insert(values.end(), row.begin(), row.end());
    values.insert(values.end(), control.begin(), control.end());
  }
  Arrays out;
  out.numbers["clips"] =
      Tensor::fromFloats({1, static_cast<int64_t>(controls.size()), 66}, values.data());
  return out;
}

TEST(FieldNpz, WorldMotionFollowsTheControlsByTheFieldsConvention) {
  // By hand: frame 0 at the origin; it then turns by dyaw = 90 degrees (R = Ry(-90)) and steps
  // R (0, 0, 2) = (-2, 0, 0); frame 1 goes R (1, 0, 0) = (0, 0, 1) further.
  const float quarter = static_cast<float>(M_PI / 2);
  const std::vector<Clip> clips =
      clipsFromArrays(fieldArrays({{0, 2, quarter}, {1, 0, 0}, {0, 0, 0}}), "a.npz", {.unit = "m"});
  ASSERT_EQ(clips.size(), 1u);
  const Clip& clip = clips[0];
  EXPECT_LT((clip.at(0, 1) - Vec3(1, 1, 0)).norm(), 1e-6f);
  EXPECT_LT((clip.at(1, 0) - Vec3(-2, 1, 0)).norm(), 1e-6f);
  EXPECT_LT((clip.at(1, 1) - Vec3(-2, 1, 1)).norm(), 1e-6f);
  EXPECT_LT((clip.at(2, 0) - Vec3(-2, 1, 1)).norm(), 1e-6f);
}

TEST(FieldNpz, UnitAndRateAreTheFieldsHabitAndNoted) {
  const Clip clip = clipsFromArrays(fieldArrays({{0, 0, 0}}), "dir/a.npz").at(0);
  EXPECT_NEAR(clip.at(0, 0).y(), 0.056444f, 1e-6f);
  EXPECT_EQ(clip.fps, 20.0);
  EXPECT_EQ(clip.name, "a_0000");
  EXPECT_TRUE(test::hasNote(clip, "5.6444"));
  EXPECT_TRUE(test::hasNote(clip, "20 frames per second"));
}

TEST(FieldNpz, TheFieldsSpeedCheckHolds) {
  // 2.5 units per frame at 20 fps is 2.82 m/s in the field's own test control.
  const Clip clip =
      clipsFromArrays(fieldArrays({{0, 2.5f, 0}, {0, 2.5f, 0}, {0, 0, 0}}), "a.npz").at(0);
  EXPECT_NEAR((clip.at(2, 0) - clip.at(1, 0)).norm() * 20.0f, 2.82f, 0.005f);
}

TEST(FieldNpz, TheFirstLimbIsTheLeftLegOnPlusX) {
  const Skeleton s = locomotionSkeleton();
  validate(s, "moglow");
  const SkeletonRoles roles = rolesOf(s);
  EXPECT_EQ(roles.leftHip, 1);
  EXPECT_EQ(roles.feet, (std::vector<int>{3, 7}));
  EXPECT_EQ(roles.leftShoulder, 13);
  EXPECT_EQ(roles.mirror[16], 20);
  EXPECT_EQ(s.parents[11], 10);
}

TEST(FieldNpz, OtherShapesAreRefusedByName) {
  const std::vector<float> zeros(73 * 4, 0.0f);
  const auto parse = [](const Tensor& t) {
    return inputErrorOf([&] {
      clipsFromArrays({.numbers = {{"clips", t}}, .texts = {}, .others = {}}, "a.npz");
    });
  };
  expectContains(parse(Tensor::fromFloats({1, 4, 73}, zeros.data())), "(1, 4, 73)");
  expectContains(parse(Tensor::fromFloats({4, 66}, zeros.data())), "(clips, frames, 66)");
  expectContains(parse(Tensor::fromFloats({0, 4, 66}, zeros.data())), "at least one clip");
  expectContains(inputErrorOf([] {
                   clipsFromArrays(
                       {.numbers = {}, .texts = {{"weights", TextArray::one("x")}}, .others = {}},
                       "a.npz");
                 }),
                 "weights");
}

TEST(FieldNpz, NanIsNamedByFrameAndJoint) {
  Arrays arrays = fieldArrays({{0, 0, 0}, {0, 0, 0}});
  std::vector<float> values = arrays.numbers["clips"].toFloats();
  values[66 + 4] = NAN;
  arrays.numbers["clips"] = Tensor::fromFloats({1, 2, 66}, values.data());
  expectContains(inputErrorOf([&] { clipsFromArrays(arrays, "a.npz"); }),
                 "frame 2, joint 'LeftUpLeg'");
}

Clip positioned(Clip clip) {
  clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  return clip;
}

TEST(MareyNpz, AClipComesBackBitForBit) {
  const test::TemporaryFolder folder;
  Clip clip = positioned(test::smallPerson());
  clip.source.notes = {"from a test"};
  clip.source.eulerOrders.assign(10, "ZXY");
  clip.source.eulerOrders[4] = "";
  clip.source.eulerOrders.back() = "";
  const auto written = writeClip(clip, folder / "a.npz", {.recipe = {{"seed", 3}}}).files;
  EXPECT_EQ(written.size(), 1u);
  const Clip back = readClip(folder / "a.npz");
  EXPECT_EQ(back.name, clip.name);
  EXPECT_EQ(back.fps, clip.fps);
  EXPECT_TRUE(*back.skeleton == *clip.skeleton);
  EXPECT_EQ(back.positions.size(), clip.positions.size());
  for (size_t i = 0; i < clip.positions.size(); ++i)
    EXPECT_LT((back.positions[i] - clip.positions[i]).norm(), 1e-6f);
  for (size_t i = 0; i < clip.transforms->rotations.size(); ++i)
    EXPECT_LT(clip.transforms->rotations[i].angularDistance(back.transforms->rotations[i]), 1e-6f);
  EXPECT_EQ(back.source.eulerOrders, clip.source.eulerOrders);
  EXPECT_TRUE(test::hasNote(back, "from a test"));
  const Json recipe =
      parseJson(readNpzArrays(folder / "a.npz").texts.at("recipe").values.at(0), "recipe");
  EXPECT_EQ(recipe["seed"], 3);
}

TEST(MareyNpz, PositionsAloneComeBackBitForBit) {
  const test::TemporaryFolder folder;
  Clip clip = positioned(test::smallPerson());
  clip.transforms.reset();
  writeClip(clip, folder / "a.npz");
  const Clip back = readClip(folder / "a.npz");
  EXPECT_EQ(back.positions, clip.positions);
  EXPECT_FALSE(back.transforms);
}

TEST(MareyNpz, DamagedArraysAreRefusedByName) {
  const Clip clip = positioned(test::smallPerson(3));
  const Arrays good = arraysOfClip(clip, Json::object());
  EXPECT_EQ(clipsFromArrays(good, "a.npz").size(), 1u);
  const int64_t parents[10] = {-1, 0, 1, 2, 0, 4, 5, 0, 77, 7};
  const double minus = -1.0;
  const std::vector<float> zeros(3 * 10 * 4, 0.0f);
  const std::pair<const char*, Tensor> damages[] = {
      {"parents", Tensor::fromInt64({10}, parents)},
      {"fps", Tensor::fromDoubles({1}, &minus)},
      {"offsets", Tensor::fromFloats({3, 3}, zeros.data())},
      {"rotations", Tensor::fromFloats({3, 10, 4}, zeros.data())},
      {"translations", Tensor::fromFloats({2, 10, 3}, zeros.data())},
      {"end_site_parents", Tensor::fromInt64({1}, parents)}};
  for (const auto& [name, tensor] : damages) {
    Arrays bad = good;
    bad.numbers[name] = tensor;
    expectContains(inputErrorOf([&] { clipsFromArrays(bad, "a.npz"); }),
                   "end_site_parents" == std::string(name) ? "end_site_" : name);
  }
  Arrays bad = good;
  bad.texts["joint_names"] = TextArray::list({"a", "b"});
  expectContains(inputErrorOf([&] { clipsFromArrays(bad, "a.npz"); }), "joint_names");
  bad = good;
  const std::vector<float> nans(10, NAN);
  bad.numbers["parents"] = Tensor::fromFloats({10}, nans.data());
  expectContains(inputErrorOf([&] { clipsFromArrays(bad, "a.npz"); }), "parents");
  bad = good;
  bad.numbers.erase("fps");
  expectContains(inputErrorOf([&] { clipsFromArrays(bad, "a.npz"); }), "fps");
}

TEST(MareyNpz, FilesWithTextAsBytesAreStillRead) {
  const Clip clip = positioned(test::smallPerson(3));
  Arrays old = arraysOfClip(clip, Json::object());
  for (const auto& [name, text] : old.texts) {
    std::string lines;
    for (const std::string& value : text.values) lines += (lines.empty() ? "" : "\n") + value;
    Tensor bytes{.dtype = DType::U8, .shape = {static_cast<int64_t>(lines.size())}, .bytes = {}};
    bytes.bytes.resize(lines.size());
    std::memcpy(bytes.bytes.data(), lines.data(), lines.size());
    old.numbers[name] = bytes;
  }
  old.texts.clear();
  const Clip back = clipsFromArrays(old, "a.npz").at(0);
  EXPECT_EQ(back.name, clip.name);
  EXPECT_EQ(back.skeleton->names, clip.skeleton->names);
}

TEST(MareyNpz, OffsetsThatAreLeftOutAreMeasured) {
  const Clip clip = positioned(test::smallPerson(3));
  Arrays arrays = arraysOfClip(clip, Json::object());
  arrays.numbers.erase("offsets");
  const Clip back = clipsFromArrays(arrays, "a.npz").at(0);
  for (size_t j = 1; j < clip.skeleton->offsets.size(); ++j)
    EXPECT_NEAR(back.skeleton->offsets[j].norm(), clip.skeleton->offsets[j].norm(), 1e-5f);
  EXPECT_TRUE(test::hasNote(back, "measured"));
}

TEST(MareyNpz, OtherUnitsAreRefusedOnWriting) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(writeClip(positioned(test::smallPerson()), folder / "a.npz", {.unit = "cm"}),
               UsageError);
}

}  // namespace
}  // namespace marey::io

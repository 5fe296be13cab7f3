// NumPy arrays of joints, cases 26 and 27.
#include "io/joint_arrays.h"

#include <cmath>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "io/known_skeletons.h"
#include "io/npz_clips.h"
#include "motion/roles.h"

namespace marey::io {
namespace {

using test::expectContains;
using test::hasNote;
using test::inputErrorOf;

std::filesystem::path fixture(const std::string& name) {
  return std::filesystem::path(MAREY_SOURCE_DIR) / "tests" / "fixtures" / name;
}

Tensor walk() {
  return parseNpy(readFile(fixture("26-numpy-arrays/joints_22.npy")), "joints_22.npy");
}

Tensor reshaped(Tensor tensor, std::vector<int64_t> shape) {
  tensor.shape = std::move(shape);
  return tensor;
}

TEST(JointArrays, Case26OfTwentyTwoJointsAreReadInSmplsOrder) {
  const Clip clip = readClip(fixture("26-numpy-arrays/joints_22.npy"));
  EXPECT_EQ(clip.frameCount(), 121);
  EXPECT_EQ(clip.fps, 20.0);
  EXPECT_EQ(clip.skeleton->names[7], "left_ankle");
  EXPECT_EQ(rolesOf(*clip.skeleton).feet, (std::vector<int>{7, 8}));
  EXPECT_LT((clip.at(0, 7) - Vec3(0.09f, 0.08f, 0.35f)).norm(), 1e-6f);
  EXPECT_TRUE(hasNote(clip, "order of SMPL"));
  EXPECT_TRUE(hasNote(clip, "20 frames per second"));
  EXPECT_EQ(clip.source.unit, "m");
}

TEST(JointArrays, Case26OfFeaturesAreNamedWithWhatIsRead) {
  const std::string message =
      inputErrorOf([] { readClips(fixture("26-numpy-arrays/features_263.npy")); });
  for (const char* part : {"a NumPy array (30, 263), features", "(frames, 22, 3)", "positions",
                           "fps", "parents", "offsets", "joint_names"})
    expectContains(message, part);
}

TEST(JointArrays, OfOtherShapesAreNamed) {
  const std::pair<std::vector<int64_t>, const char*> shapes[] = {
      {{121, 66}, "save it as 'clips' (clips, frames, 66) or as (frames, 22, 3)"},
      {{11, 11, 66}, "save it as 'clips'"},
      {{22, 3, 121}, "transpose"},
      {{66, 121}, "features"},
      {{22 * 3 * 121}, "too few axes"},
      {{11, 242, 3}, "242 joints that are not named"},
      {{22, 11, 33}, "rows of 33 numbers"}};
  for (const auto& [shape, meaning] : shapes) {
    const Tensor tensor = reshaped(walk(), shape);
    const std::string message = inputErrorOf([&] { jointClips(tensor, "a.npy", {}, {}); });
    expectContains(message, meaning);
    expectContains(message, "NumPy array " + tensor.shapeText());
  }
  EXPECT_EQ(meaningOfShape({5, 22, 4}), "rotations (quaternions), not positions");
  EXPECT_EQ(meaningOfShape({5, 22, 3, 3}), "rotation matrices");
  EXPECT_EQ(meaningOfShape({0, 22, 3}), "which is empty");
}

TEST(JointArrays, OfSeveralClipsAreReadAsSuch) {
  const std::vector<Clip> clips =
      jointClips(reshaped(walk(), {11, 11, 22, 3}), "dir/a.npy", {}, {});
  ASSERT_EQ(clips.size(), 11u);
  EXPECT_EQ(clips[3].name, "a_0003");
  EXPECT_EQ(clips[3].frameCount(), 11);
}

TEST(JointArrays, OfRotationsInTheSameShapeAreRefused) {
  std::vector<float> values;
  for (int i = 0; i < 30 * 22 * 3; ++i) values.push_back(std::sin(0.7f * static_cast<float>(i)));
  const Tensor turns = Tensor::fromFloats({30, 22, 3}, values.data());
  expectContains(inputErrorOf([&] { jointClips(turns, "a.npy", {}, {}); }),
                 "no positions of SMPL's joints");
}

TEST(JointArrays, NanIsNamedByClipFrameAndJoint) {
  std::vector<float> values = walk().toFloats();
  values[(11 + 4) * 66 + 3 * 7 + 1] = NAN;
  const Tensor tensor = Tensor::fromFloats({11, 11, 22, 3}, values.data());
  expectContains(inputErrorOf([&] { jointClips(tensor, "a.npy", {}, {}); }),
                 "clip 1 (of 0 to 10), frame 5, joint 'left_ankle'");
}

TEST(JointArrays, SmplsSkeletonsAreTreesWithSides) {
  for (const int joints : {22, 24, 52, 55}) {
    const auto skeleton = smplSkeleton(joints);
    ASSERT_NE(skeleton, nullptr);
    ASSERT_EQ(skeleton->jointCount(), joints);
    validate(*skeleton, "smpl");
    const SkeletonRoles roles = rolesOf(*skeleton);
    EXPECT_EQ(roles.leftHip, 1);
    EXPECT_EQ(roles.leftShoulder, 16);
    EXPECT_EQ(roles.feet, (std::vector<int>{7, 8}));
    EXPECT_EQ(roles.mirror[20], 21);
  }
  EXPECT_EQ(smplSkeleton(21), nullptr);
  // The last of the left thumb hangs below its second joint, which hangs from the wrist's chain.
  const auto hands = smplSkeleton(52);
  EXPECT_EQ(hands->names[36], "left_thumb3");
  EXPECT_EQ(hands->parents[34], 20);
  EXPECT_EQ(hands->parents[37], 21);
}

TEST(NpzDialects, Case27AreReadBesideTextDatesAndObjects) {
  const std::string csv = readFile(fixture("27-npz-dialects/expected.csv"));
  for (const char* name : {"f4.npz", "with_text_and_object_arrays.npz"}) {
    const std::vector<Clip> clips = readClips(fixture(std::string("27-npz-dialects/") + name));
    ASSERT_EQ(clips.size(), 2u) << name;
    EXPECT_EQ(clips[0].frameCount(), 80);
    int compared = 0;
    size_t at = csv.find('\n') + 1;
    int frame = 0, joint = 0;
    float x = 0, y = 0, z = 0;
    for (; at < csv.size(); at = csv.find('\n', at) + 1) {
      ASSERT_EQ(std::sscanf(csv.c_str() + at, "%d,%d,%f,%f,%f", &frame, &joint, &x, &y, &z), 5);
      for (const Clip& clip : clips)
        EXPECT_LT((clip.at(frame, joint) - Vec3(x, y, z)).norm(), 1e-4f) << frame << " " << joint;
      ++compared;
    }
    EXPECT_GT(compared, 60);
  }
}

TEST(NpzDialects, Case27NanIsNamedByClipFrameAndJoint) {
  expectContains(inputErrorOf([] { readClips(fixture("27-npz-dialects/nan_in_clip_1.npz")); }),
                 "clip 1 (of 0 to 1), frame 11, joint 'LeftUpLeg'");
}

TEST(NpzDialects, Case27CutIsDamagedOrCut) {
  const std::string message =
      inputErrorOf([] { readClips(fixture("27-npz-dialects/truncated.npz")); });
  expectContains(message, "damaged or cut");
  EXPECT_EQ(message.find("Not a zip"), std::string::npos) << message;
}

NpzArrays arraysOf(std::map<std::string, Tensor> numbers) {
  return {.numbers = std::move(numbers), .texts = {}, .others = {}};
}

TEST(NpzDialects, TheOnlyArrayOfJointsIsReadUnderAnyName) {
  const double fps = 30.0;
  const Clip clip =
      clipsFromArrays(arraysOf({{"arr_0", walk()}, {"fps", Tensor::fromDoubles({}, &fps)}}),
                      "a.npz")
          .at(0);
  EXPECT_EQ(clip.fps, 30.0);
  EXPECT_TRUE(hasNote(clip, "'arr_0'"));
  EXPECT_EQ(clipsFromArrays(arraysOf({{"positions", walk()}}), "a.npz").at(0).frameCount(), 121);
  expectContains(inputErrorOf([] {
                   clipsFromArrays(arraysOf({{"predicted", walk()}, {"true", walk()}}), "a.npz");
                 }),
                 "'predicted' float32 (121, 22, 3), 'true'");
}

TEST(NpzDialects, BodyParametersAreNamed) {
  const std::vector<float> zeros(156 * 2, 0.0f);
  expectContains(inputErrorOf([&] {
                   clipsFromArrays(arraysOf({{"poses", Tensor::fromFloats({2, 156}, zeros.data())},
                                             {"trans", Tensor::fromFloats({2, 3}, zeros.data())}}),
                                   "a.npz");
                 }),
                 "AMASS");
}

}  // namespace
}  // namespace marey::io

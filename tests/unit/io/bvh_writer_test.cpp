#include <cmath>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/bvh.h"
#include "io/clip_io.h"
#include "motion/kinematics.h"

namespace marey::io {
namespace {

using test::smallPerson;

Clip positioned(Clip clip) {
  clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  return clip;
}

double largestDistance(const Clip& a, const Clip& b) {
  double out = 0.0;
  for (int t = 0; t < a.frameCount(); ++t)
    for (int j = 0; j < a.jointCount(); ++j)
      out = std::max<double>(
          out, (a.at(t, j) - b.at(t, b.skeleton->find(a.skeleton->names[static_cast<size_t>(j)])))
                   .norm());
  return out;
}

TEST(BvhWriter, RotationsAndPositionsComeBackInEveryOrderAndUnit) {
  const test::TemporaryFolder folder;
  const Clip clip = positioned(smallPerson());
  for (const char* order : {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"})
    for (const char* unit : {"cm", "m", "inch"}) {
      writeClip(clip, folder / "a.bvh", {.unit = unit, .eulerOrder = order});
      const Clip back = readClip(folder / "a.bvh", {.unit = unit});
      ASSERT_EQ(back.frameCount(), clip.frameCount());
      EXPECT_EQ(back.skeleton->names, clip.skeleton->names);
      EXPECT_EQ(back.source.eulerOrders[1], order);
      EXPECT_LT(largestDistance(clip, back), 5e-6) << order << unit;
      for (size_t i = 0; i < clip.transforms->rotations.size(); ++i)
        EXPECT_LT(clip.transforms->rotations[i].angularDistance(back.transforms->rotations[i]),
                  2e-6f)
            << order;
      EXPECT_LT((back.skeleton->endSites[0].offset - clip.skeleton->endSites[0].offset).norm(),
                1e-5f);
    }
}

TEST(BvhWriter, ARateThatIsNoWholeNumberComesBackExactly) {
  const test::TemporaryFolder folder;
  for (const double fps : {20.0, 29.97, 30.0, 59.94, 60.0, 100.0, 119.88, 120.0}) {
    writeClip(positioned(smallPerson(5, fps)), folder / "a.bvh");
    const Clip back = readClip(folder / "a.bvh");
    EXPECT_NEAR(back.fps, fps, 1e-8 * fps);
    EXPECT_FALSE(test::hasNote(back, "frame time")) << fps;
  }
}

TEST(BvhWriter, AnglesDoNotJumpByWholeTurns) {
  const test::TemporaryFolder folder;
  Clip clip = smallPerson(100);
  for (int t = 0; t < 100; ++t)  // Hips turn three times about Y
    clip.transforms->rotations[static_cast<size_t>(t) * 10] =
        Quat(Eigen::AngleAxisf(0.2f * static_cast<float>(t), Vec3::UnitY()));
  writeClip(positioned(clip), folder / "a.bvh");
  const std::string text = readFile(folder / "a.bvh");
  const size_t rows = text.find('\n', text.find("Frame Time")) + 1;
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  std::istringstream numbers(last);
  double value = 0.0;
  for (int i = 0; i < 6; ++i) numbers >> value;
  EXPECT_NEAR(value, 0.2 * 99 * 180.0 / M_PI, 1e-3);
  EXPECT_GT(rows, 0u);
}

TEST(BvhWriter, AClipOfPositionsAloneBecomesRotationsAndItsResidualIsTheStatedOne) {
  const test::TemporaryFolder folder;
  Clip clip = positioned(smallPerson());
  clip.transforms.reset();
  for (size_t i = 0; i < clip.positions.size(); ++i)
    clip.positions[i].z() += 0.01f * static_cast<float>(std::sin(2.3 * static_cast<double>(i)));
  const WrittenClip written = writeClip(clip, folder / "a.bvh", {.recipe = {{"seed", 7}}});
  const Clip back = readClip(folder / "a.bvh");
  const double largest = largestDistance(clip, back);
  EXPECT_GT(largest, 0.002);
  ASSERT_TRUE(written.fit);
  EXPECT_NEAR(written.fit->largestM(), largest, 1e-5);
  const Json recipe = readJson(folder / "a.bvh.recipe.json");
  EXPECT_EQ(recipe["seed"], 7);
  test::expectContains(recipe["fit"]["note"].get<std::string>(), "positions only");
  EXPECT_NEAR(recipe["fit"]["fit_residual_max_cm"].get<double>(), 100.0 * largest, 1e-3);
  EXPECT_EQ(recipe["fit"]["fit_residual_cm"].size(), 10u);
  // Bones are constant and turn: only the root has position channels.
  const std::string text = readFile(folder / "a.bvh");
  EXPECT_EQ(text.find("CHANNELS 6"), text.rfind("CHANNELS 6"));
}

TEST(BvhWriter, AClipWithRotationsIsNotFitted) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(writeClip(positioned(smallPerson()), folder / "a.bvh").fit);
  EXPECT_FALSE(readJson(folder / "a.bvh.recipe.json").contains("fit"));
}

TEST(BvhWriter, ZUpFilesComeBackAsTheyWere) {
  const test::TemporaryFolder folder;
  Clip clip = positioned(smallPerson());
  writeClip(clip, folder / "a.bvh", {.up = "z"});
  EXPECT_LT(largestDistance(clip, readClip(folder / "a.bvh", {.up = "z"})), 1e-5);
  EXPECT_NEAR(readClip(folder / "a.bvh", {.up = "y"}).at(0, 0).z(), 0.9f, 1e-3f);
  clip.transforms.reset();
  writeClip(clip, folder / "b.bvh", {.up = "z"});
  EXPECT_LT(largestDistance(clip, readClip(folder / "b.bvh", {.up = "z"})), 1e-5);
}

TEST(BvhWriter, JointsInAnotherOrderAreWrittenDepthFirst) {
  const test::TemporaryFolder folder;
  Clip clip;
  Skeleton s;
  s.names = {"root", "a", "b", "childOfA"};
  s.parents = {-1, 0, 0, 1};
  s.offsets = {Vec3::Zero(), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0)};
  clip.skeleton = std::make_shared<const Skeleton>(s);
  clip.fps = 30.0;
  clip.transforms = {std::vector<Quat>(4, Quat(Eigen::AngleAxisf(0.3f, Vec3::UnitX()))), s.offsets};
  clip = positioned(clip);
  writeClip(clip, folder / "a.bvh", {.unit = "m"});
  const Clip back = readClip(folder / "a.bvh", {.unit = "m"});
  EXPECT_EQ(back.skeleton->names, (std::vector<std::string>{"root", "a", "childOfA", "b"}));
  EXPECT_LT(largestDistance(clip, back), 1e-5);
}

TEST(BvhWriter, TheRecipeLiesBesideTheFile) {
  const test::TemporaryFolder folder;
  const auto written =
      writeClip(positioned(smallPerson()), folder / "a.bvh", {.recipe = {{"seed", 7}}}).files;
  EXPECT_EQ(written,
            (std::vector<std::filesystem::path>{folder / "a.bvh", folder / "a.bvh.recipe.json"}));
  const Json recipe = readJson(written[1]);
  EXPECT_EQ(recipe["seed"], 7);
  EXPECT_EQ(recipe["export"]["unit"], "cm");
  EXPECT_EQ(recipe["export"]["euler_order"], "ZXY");
}

TEST(BvhWriter, AClipWithoutFramesOrWithNanIsRefused) {
  const test::TemporaryFolder folder;
  Clip clip = positioned(smallPerson(3));
  clip.positions[12].x() = NAN;
  test::expectContains(test::inputErrorOf([&] { writeClip(clip, folder / "a.bvh"); }),
                       "frame 2, joint 'LeftLeg'");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.bvh"));
  EXPECT_THROW(writeClip(positioned(smallPerson()), folder / "a.bvh", {.eulerOrder = "ZXZ"}),
               UsageError);
}

}  // namespace
}  // namespace marey::io

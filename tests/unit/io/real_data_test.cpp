// Checks on real motion capture that lies beside the project and is no part of it.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "io/doctor.h"
#include "io/text.h"
#include "motion/kinematics.h"
#include "motion/roles.h"

namespace marey::io {
namespace {

namespace fs = std::filesystem;

/// The folder of the data, or a skip; where continuous integration runs its absence is a failure.
#define MAREY_DATA(folder, name)                                                     \
  const fs::path folder = fs::path(MAREY_SHARED_DIR) / "data" / (name);              \
  if (!fs::exists(folder)) {                                                         \
    if (std::getenv("CI") != nullptr) FAIL() << "the data is not there: " << folder; \
    GTEST_SKIP() << "real motion data is not there: " << folder;                     \
  }

TEST(RealData, TheSameTakeAsAmcAndAsBvhHasTheSameWorldMotion) {
  MAREY_DATA(cmu, "cmu");
  const Clip amc = readClip(cmu / "01_01.amc"), bvh = readClip(cmu / "01_01.bvh");
  // The conversion put a T-pose in front; its frame t + 1 is the take's frame t.
  ASSERT_EQ(bvh.frameCount(), amc.frameCount() + 1);
  ASSERT_EQ(bvh.jointCount(), amc.jointCount());
  EXPECT_EQ(bvh.source.unit, "cmu");
  const std::vector<Quat> a = globalRotations(*amc.skeleton, *amc.transforms);
  const std::vector<Quat> b = globalRotations(*bvh.skeleton, *bvh.transforms);
  const auto width = static_cast<size_t>(amc.jointCount());
  double angle = 0.0;
  for (size_t i = 0; i < a.size(); ++i)
    angle = std::max<double>(angle, a[i].angularDistance(b[i + width]));
  EXPECT_LT(angle, 2e-5) << "radians, every joint and frame";
  // Joint places: the conversion gave joints that hang on a branching bone no offset (neck,
  // clavicles, finger and thumb bases), so places agree up to there: hips, legs and spine.
  double most = 0.0, sum = 0.0;
  long count = 0;
  for (int t = 0; t < amc.frameCount(); ++t)
    for (int j = 0; j < 14; ++j) {
      const double distance = (amc.at(t, j) - bvh.at(t + 1, j)).norm();
      most = std::max(most, distance);
      sum += distance;
      ++count;
    }
  EXPECT_LT(most, 2e-5) << "metres";
  EXPECT_LT(sum / static_cast<double>(count), 3e-6) << "metres";
  RecordProperty("max_m", std::to_string(most));
  // With the AMC's offsets at those joints the rest of the body agrees as well.
  JointTransforms completed = *bvh.transforms;
  for (size_t i = 0; i < completed.translations.size(); ++i)
    if (i % width != 0) completed.translations[i] = amc.skeleton->offsets[i % width];
  const std::vector<Vec3> whole = forwardKinematics(*amc.skeleton, completed);
  for (size_t i = 0; i < amc.positions.size(); ++i)
    ASSERT_LT((whole[i + width] - amc.positions[i]).norm(), 3e-5f) << i;
}

TEST(RealData, MixedEulerOrdersInOneFileAreKept) {
  MAREY_DATA(cmu, "cmu");
  const DoctorReport report = examine(cmu / "131_01.bvh").at(0);
  EXPECT_EQ(report.eulerOrders, (std::map<std::string, int>{{"ZXY", 12}, {"ZYX", 19}}));
  EXPECT_EQ(report.fps, 120.0);
  EXPECT_EQ(report.frames, 994);
  EXPECT_EQ(report.sides.value, "as named");
}

TEST(RealData, TheCalibrationPoseOfAConvertedTakeIsFound) {
  MAREY_DATA(cmu, "cmu");
  const DoctorReport report = examine(cmu / "01_01.bvh").at(0);
  const auto faultsOf = [&](const char* kind) {
    return std::count_if(report.faults.begin(), report.faults.end(),
                         [&](const Fault& fault) { return fault.kind == kind; });
  };
  EXPECT_EQ(faultsOf("calibration_pose"), 1);
  EXPECT_EQ(faultsOf("teleport"), 0) << "the step out of the pose is no fault of its own";
}

TEST(RealData, ARewrittenBvhHasTheSameRotations) {
  MAREY_DATA(bandai, "bandai");
  const test::TemporaryFolder folder;
  const Clip clip = readClip(bandai / "dataset-1_walk_normal_001.bvh");
  for (const char* order : {"ZXY", "XYZ"}) {
    writeClip(clip, folder / "again.bvh", {.eulerOrder = order});
    const Clip back = readClip(folder / "again.bvh");
    ASSERT_EQ(back.skeleton->names, clip.skeleton->names);
    for (size_t i = 0; i < clip.positions.size(); ++i) {
      ASSERT_LT(back.transforms->rotations[i].angularDistance(clip.transforms->rotations[i]), 3e-6f)
          << i;
      ASSERT_LT((back.positions[i] - clip.positions[i]).norm(), 1e-5f) << i;
    }
  }
}

TEST(RealData, EveryBandaiClipIsAPersonOf21JointsInCentimetresAndReadsFast) {
  MAREY_DATA(bandai, "bandai");
  std::vector<std::pair<fs::path, std::string>> files;
  size_t bytes = 0;
  for (const char* list : {"train.txt", "test.txt"}) {
    const std::string text = readFile(bandai / list);
    LineReader lines(text, list);
    while (const auto line = lines.nextFilled()) {
      const fs::path path = bandai / std::string(trim(*line));
      bytes += fs::file_size(path);
      files.emplace_back(path, readFile(path));  // warm: the reader is measured, not the disk
    }
  }
  EXPECT_EQ(files.size(), 973u);
  const std::clock_t begin = std::clock();
  long frames = 0, promised = 0;
  std::shared_ptr<const Skeleton> first;
  for (const auto& [path, text] : files) {
    const Clip clip = readClip(path);
    frames += clip.frameCount();
    promised += std::stol(text.substr(text.find("Frames:") + 7));
    if (!first) first = clip.skeleton;
    ASSERT_EQ(clip.skeleton->names, first->names) << path;
    ASSERT_EQ(clip.source.unit, "cm") << path;
    ASSERT_EQ(clip.fps, 30.0) << path;
  }
  const double cpu = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const double rate = static_cast<double>(bytes) / 1e6 / cpu;
  std::cout << "read " << bytes / 1000000 << " MB in " << cpu << " s of one core: " << rate
            << " MB/s\n";
  EXPECT_EQ(frames, promised);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
  EXPECT_GT(rate, 50.0);
#endif
}

TEST(RealData, TheDogHasRigidBonesFourToesAndItsLeftOnTheLeft) {
  MAREY_DATA(dog, "dog");
  const std::vector<DoctorReport> reports = examine(dog / "dog_walk00_joint_pos.txt");
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].frames, 593);
  EXPECT_LT(reports[0].boneDrift.maxStdM, 1e-4);
  EXPECT_EQ(reports[0].sides.value, "as named");
  EXPECT_NEAR(*reports[0].floorM, 0.0, 0.01);
  EXPECT_EQ(rolesOf(*readClip(dog / "dog_walk00_joint_pos.txt").skeleton).feet,
            (std::vector<int>{10, 15, 19, 23}));
}

}  // namespace
}  // namespace marey::io

// Representations of real motion capture, which lies beside the project and is no part of it.
#include <cstdlib>

#include "unit/io/support.h"

#include "io/clip_io.h"
#include "motion/kinematics.h"
#include "motion/representation/representation.h"
#include "motion/resample.h"
#include "motion/roles.h"
#include "motion/rotation.h"

namespace marey::io {
namespace {

namespace fs = std::filesystem;

#define MAREY_DATA(folder, name)                                                     \
  const fs::path folder = fs::path(MAREY_SHARED_DIR) / "data" / (name);              \
  if (!fs::exists(folder)) {                                                         \
    if (std::getenv("CI") != nullptr) FAIL() << "the data is not there: " << folder; \
    GTEST_SKIP() << "real motion data is not there: " << folder;                     \
  }

const FeatureSpec kSpec{.layout = "joint-expmap"};

struct Encoded {
  std::shared_ptr<const Skeleton> skeleton;
  FeatureSequence features;
  Clip source;  ///< at the features' rate
};

Encoded encoded(const Clip& clip) {
  const auto& poses = representationNamed(kSpec.layout, {});
  Encoded out{.skeleton = poses.skeletonOf({clip}, kSpec),
              .features = {},
              .source = resampled(clip, kSpec.fps)};
  out.features = extractFeatures(clip, kSpec, out.skeleton);
  return out;
}

Clip decoded(const FeatureSequence& f, const std::shared_ptr<const Skeleton>& skeleton) {
  return rebuildMotion(f.pose, f.control, f.start, skeleton, kSpec);
}

double farthest(const Clip& a, const Clip& b) {
  double out = 0.0;
  for (size_t i = 0; i < a.positions.size(); ++i)
    out = std::max(out, (a.positions[i] - b.positions[i]).cast<double>().norm());
  return out;
}

/// Of joint angles from one frame to the next.
float largestStep(const Matrix& pose) {
  const long n = pose.rows() - 1;
  return (pose.bottomRows(n) - pose.topRows(n)).rightCols(pose.cols() - 3).cwiseAbs().maxCoeff();
}

TEST(RealRepresentation, RotationsOfRealClipsComeBack) {
  MAREY_DATA(bandai, "bandai");
  for (const char* name : {"dataset-1_walk_normal_001.bvh", "dataset-1_run_normal_001.bvh",
                           "dataset-1_dash_active_001.bvh", "dataset-1_kick_normal_001.bvh"}) {
    const Encoded e = encoded(readClip(bandai / name));
    const Clip back = decoded(e.features, e.skeleton);
    ASSERT_EQ(back.positions.size(), e.source.positions.size()) << name;
    EXPECT_EQ(e.features.fitM, 0.0) << name;
    EXPECT_LT(farthest(back, e.source), 1e-4) << name;
    const auto own = globalRotations(*e.source.skeleton, *e.source.transforms);
    const auto found = globalRotations(*back.skeleton, *back.transforms);
    for (size_t i = 0; i < own.size(); ++i)
      ASSERT_LT(angleBetween(own[i].cast<double>(), found[i].cast<double>()), 2e-5) << name;
    EXPECT_LT(largestStep(e.features.pose), 2.5f) << name << ": no jump of a whole turn";
  }
}

TEST(RealRepresentation, MirroredRealClipsAreTheWorldMirrored) {
  MAREY_DATA(bandai, "bandai");
  const Encoded e = encoded(readClip(bandai / "dataset-1_walk_normal_001.bvh"));
  const Clip other = decoded(mirrored(e.features, kSpec, *e.skeleton), e.skeleton);
  const auto mirror = rolesOf(*e.skeleton).mirror;
  for (int t = 0; t < e.source.frameCount(); ++t)
    for (int j = 0; j < e.source.jointCount(); ++j) {
      const Vec3 p = e.source.at(t, mirror[static_cast<size_t>(j)]);
      // Its two sides differ by up to 0.4 mm per bone.
      ASSERT_LT((other.at(t, j) - Vec3(-p.x(), p.y(), p.z())).norm(), 2e-3f)
          << e.skeleton->names[static_cast<size_t>(j)] << " " << t;
    }
}

TEST(RealRepresentation, BodiesWithOtherAxesAreNoDifferent) {
  MAREY_DATA(cmu, "cmu");
  for (const char* name : {"01_01.amc", "11_01.amc", "131_01.bvh"}) {
    const Clip whole = readClip(cmu / name);
    const Encoded e = encoded(sliceFrames(whole, 0, std::min(1200, whole.frameCount())));
    EXPECT_EQ(e.features.fitM, 0.0) << name;
    EXPECT_LT(farthest(decoded(e.features, e.skeleton), e.source), 1e-4) << name;
  }
}

TEST(RealRepresentation, PositionsAloneGetRotationsWithinTheFitsDistance) {
  MAREY_DATA(dog, "dog");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(dog))
    if (entry.path().extension() == ".txt" && entry.file_size() > 10000)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  const Clip whole = readClip(files.front());
  const Encoded e = encoded(sliceFrames(whole, 0, std::min(600, whole.frameCount())));
  EXPECT_GT(e.features.fitM, 0.0);
  RecordProperty("fit_m", std::to_string(e.features.fitM));
  const Clip back = decoded(e.features, e.skeleton);
  ASSERT_TRUE(back.transforms);
  // Bones of the decoded motion are those of the first clip, here the same one.
  EXPECT_LT(farthest(back, e.source), e.features.fitM + 0.02);
}

}  // namespace
}  // namespace marey::io

// Footsteps of real motion capture against an independent implementation.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "motion/resample.h"
#include "stats/footsteps.h"

namespace marey::stats {
namespace {

namespace fs = std::filesystem;

fs::path dataFolder() {
  return fs::path(MAREY_SHARED_DIR) / "data" / "bandai";
}

FootstepCurve curveAt20Fps(const std::vector<fs::path>& files) {
  std::vector<Clip> clips;
  for (const fs::path& file : files) clips.push_back(resampled(io::readClip(file), 20.0));
  return footstepCurve(clips, {.feet = feetOf(*clips.front().skeleton, "Foot_L,Foot_R")});
}

class NaturalMotion : public testing::Test {
 protected:
  void SetUp() override {
    if (fs::exists(dataFolder())) return;
    if (std::getenv("CI")) FAIL() << dataFolder() << " is missing";
    GTEST_SKIP() << dataFolder() << " is missing: this test needs the Bandai-Namco data";
  }
};

// The expected numbers come from a NumPy and SciPy program of its own: BVH read with rotation
// matrices, turned to 20 fps by scipy's Slerp and CubicHermiteSpline, runs found by differences of
// the speed mask.
TEST_F(NaturalMotion, OfTheHeldOutClipsHasTheFootstepsThatNumPyCounts) {
  std::vector<fs::path> files;
  std::istringstream list(readFile(dataFolder() / "test.txt"));
  for (std::string name; list >> name;) files.push_back(dataFolder() / name);
  const FootstepCurve curve = curveAt20Fps(files);
  EXPECT_EQ(curve.maxCount, 1253);
  EXPECT_EQ(curve.v95CmS, 12.0);
  EXPECT_NEAR(curve.durationMeanS, 0.2415, 1e-5);
  EXPECT_NEAR(curve.durationStdS, 0.155291, 1e-5);
}

TEST_F(NaturalMotion, OfWalkingHasASharpContact) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(dataFolder()))
    if (entry.path().filename().string().starts_with("dataset-2_walk_"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const FootstepCurve curve = curveAt20Fps(files);
  EXPECT_EQ(curve.maxCount, 3065);
  EXPECT_EQ(curve.v95CmS, 6.0);
}

}  // namespace
}  // namespace marey::stats

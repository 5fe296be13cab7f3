// Statistics that name a published code give that code's number on a prepared clip.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "io/clip_io.h"
#include "stats/footsteps.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

namespace fs = std::filesystem;

double shareOf(const std::string& file, const std::string& feet, const char* statistic) {
  const std::vector<Clip> clips = {io::readClip(
      fs::path(MAREY_SOURCE_DIR) / "tests/fixtures/34-foot-skate-as-published" / file)};
  StatisticInput input{.clips = &clips, .feet = feetOf(*clips.front().skeleton, feet)};
  if (!feet.empty()) input.toes = input.feet;
  return valueOf(statisticByName(statistic), input);
}

// Case 34. Expected: the skating ratio of Guided Motion Diffusion's code, worked out apart.
TEST(Published, TheSkatingRatioIsThatOfGuidedMotionDiffusion) {
  EXPECT_NEAR(shareOf("slips.npz", "", "foot_skate_share"), 7.5, 1e-9);
  EXPECT_NEAR(shareOf("slips_floor_at_10cm.npz", "", "foot_skate_share"), 0.0, 1e-9);
  EXPECT_NEAR(shareOf("slips.npz", "L_Foot,R_Foot", "foot_skate_share"), 7.5, 1e-9);
  EXPECT_NEAR(shareOf("slips.npz", "L_Ankle,R_Ankle", "foot_skate_share"), 0.0, 1e-9);
}

TEST(Published, OtherNumbersOfThatClipAreAsExpected) {
  EXPECT_NEAR(shareOf("slips.npz", "", "foot_skate_height_weighted"), 5.0, 1e-3);
  EXPECT_NEAR(shareOf("slips.npz", "", "foot_contact_share"), 88.125, 1e-9);
}

TEST(Documented, EveryStatisticIsInThePageOfStatistics) {
  std::ifstream in(fs::path(MAREY_SOURCE_DIR) / "docs/statistics.md");
  std::stringstream text;
  text << in.rdbuf();
  for (const Statistic& s : allStatistics()) {
    // A heading or a row of its own, or with its pair ("joint_speed_wasserstein").
    EXPECT_NE(text.str().find("`" + s.name + "`"), std::string::npos) << s.name;
  }
}

}  // namespace
}  // namespace marey::stats

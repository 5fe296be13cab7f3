// Against vectors that the published implementation computed, and the published sizes.
#include "model/conformance.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "moglow/family.h"

namespace marey {
namespace {

class PublishedVectors : public testing::TestWithParam<const char*> {};

TEST_P(PublishedVectors, AreReproduced) {
  const auto folder =
      std::filesystem::path(MAREY_SHARED_DIR) / "conformance" / "moglow" / GetParam();
  if (!std::filesystem::exists(folder)) {
    if (std::getenv("CI") != nullptr) FAIL() << folder << " is missing";
    GTEST_SKIP() << "the conformance vectors are not here: " << folder;
  }
  const auto config = (folder / "config.json").string();
  const Json json = readJson(config);
  const auto model = moglow::importCheckpoint({.checkpoint = (folder / "checkpoint.pkg").string(),
                                               .config = json,
                                               .configOrigin = config,
                                               .standardiser = {},
                                               .variant = "test",
                                               .stateDict = ""});
  EXPECT_EQ(model->info().parameters, json["parameters"].get<int64_t>());
  const auto errors = checkConformance(*model, (folder / "vectors.npz").string());
  EXPECT_GT(errors.frames, 0);
  EXPECT_LE(errors.latent, 1e-4);
  EXPECT_LE(errors.sample, 1e-4);
  EXPECT_LE(errors.loglik, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(MoGlow, PublishedVectors,
                         testing::Values("tiny-lu", "plain-weight", "human-63"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

double millionParameters(const std::string& name) {
  const std::string path = std::string(MAREY_SOURCE_DIR) + "/resources/models/" + name + ".json";
  return static_cast<double>(moglow::family().describe(readJson(path), path).parameters) / 1e6;
}

TEST(ParameterCount, IsThatOfThePapers) {
  EXPECT_NEAR(millionParameters("moglow-human"), 73.86, 0.005);
  EXPECT_NEAR(millionParameters("moglow-dog"), 80.0, 0.5);
  EXPECT_NEAR(millionParameters("mg-h"), 54.0, 0.5);
}

}  // namespace
}  // namespace marey

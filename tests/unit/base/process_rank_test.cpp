#include "base/process_rank.h"

#include <cstdlib>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

ProcessRank rankIn(const std::map<std::string, std::string>& environment) {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE",
                           "RANK", "WORLD_SIZE"})
    unsetenv(name);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  return processRank();
}

std::string refusal(const std::map<std::string, std::string>& environment) {
  try {
    rankIn(environment);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ProcessRank, IsOneAloneWithoutALauncher) {
  EXPECT_EQ(rankIn({}).rank, 0);
  EXPECT_EQ(rankIn({}).size, 1);
}

TEST(ProcessRank, IsWhatEachLauncherSays) {
  for (const auto& [rank, size] :
       std::map<std::string, std::string>{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                          {"PMI_RANK", "PMI_SIZE"},
                                          {"RANK", "WORLD_SIZE"}}) {
    const ProcessRank found = rankIn({{rank, "2"}, {size, "3"}});
    EXPECT_EQ(found.rank, 2) << rank;
    EXPECT_EQ(found.size, 3) << rank;
  }
}

TEST(ProcessRank, HalvesAndNonsenseAreRefusedByName) {
  EXPECT_NE(refusal({{"RANK", "0"}}).find("WORLD_SIZE"), std::string::npos);
  EXPECT_NE(refusal({{"PMI_SIZE", "2"}}).find("PMI_RANK"), std::string::npos);
  EXPECT_NE(refusal({{"RANK", "two"}, {"WORLD_SIZE", "3"}}).find("'two'"), std::string::npos);
  EXPECT_NE(refusal({{"RANK", "3"}, {"WORLD_SIZE", "3"}}).find("below 3"), std::string::npos);
  EXPECT_NE(refusal({{"RANK", "-1"}, {"WORLD_SIZE", "3"}}).find("'-1'"), std::string::npos);
}

}  // namespace
}  // namespace marey

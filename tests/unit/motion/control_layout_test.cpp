// Layouts as they are stored, and those that cannot be.
#include "motion/control/control_layout.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

Json whole() {
  return Json::parse(R"([
    {"name": "root", "kind": "root_motion"},
    {"name": "path", "kind": "future_path", "optional": true, "ahead_s": [0.2, 1.0]},
    {"name": "type", "kind": "label", "labels": ["walk", "run"], "transition_s": 0.5,
     "from_names": true},
    {"name": "body", "kind": "skeleton", "joints": 27},
    {"name": "speech", "kind": "array", "columns": ["a", "b"], "fps": 100.0, "past_s": 0.1,
     "future_s": 1.0}])");
}

TEST(ControlLayout, ComesBackFromJson) {
  const ControlLayout layout = controlLayoutFromJson(whole(), "test");
  EXPECT_EQ(toJson(layout), whole());
  EXPECT_EQ(controlLayoutFromJson(toJson(layout), "test"), layout);
  EXPECT_TRUE(isRootMotionAlone({ControlChannel{}}));
  EXPECT_FALSE(isRootMotionAlone(layout));
}

/// 27 joints: the 82 values of Liu et al. 2021.
TEST(ControlLayout, ColumnsFollowEachOther) {
  const ControlLayout layout = controlLayoutFromJson(whole(), "test");
  const auto at = columnsOf(layout, 20.0);
  const int first[] = {0, 3, 8, 10, 92}, width[] = {3, 4, 2, 82, 2 * (2 + 1 + 20)};
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(at[i].first, first[i]) << i;
    EXPECT_EQ(at[i].width, width[i]) << i;
    EXPECT_EQ(at[i].presence, i == 1 ? 7 : -1) << i;
  }
  EXPECT_EQ(widthOf(layout, 20.0), 92 + 46);
}

TEST(ControlLayout, WhatCannotBeIsNamed) {
  const auto refused = [](const std::function<void(Json&)>& change) -> std::string {
    Json json = whole();
    change(json);
    try {
      controlLayoutFromJson(json, "model.marey");
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  };
  const std::pair<std::function<void(Json&)>, const char*> wrong[] = {
      {[](Json& j) { j.erase(0); }, "root motion as the first"},
      {[](Json& j) { j[0]["optional"] = true; }, "cannot be left out"},
      {[](Json& j) { j[1]["ahead_s"] = {-1.0}; }, "60 s ahead"},
      {[](Json& j) { j[2]["labels"] = {"walk"}; }, "two labels"},
      {[](Json& j) {
         j[2]["labels"] = {"walk", "walk"};
       },
       "names that differ"},
      {[](Json& j) { j[2]["lables"] = 1; }, "control[2].lables"},
      {[](Json& j) { j[3]["joints"] = 0; }, "number of joints"},
      {[](Json& j) { j[4]["kind"] = "sound"; }, "'sound'"},
      {[](Json& j) { j[4]["future_s"] = 1e9; }, "0 to 60 s"},
      {[](Json& j) { j[4]["name"] = "type"; }, "names that differ"},
      {[](Json& j) { j.push_back(j[2]); }, "names that differ"}};
  for (const auto& [change, expected] : wrong)
    EXPECT_NE(refused(change).find(expected), std::string::npos)
        << expected << ": " << refused(change);
}

}  // namespace
}  // namespace marey

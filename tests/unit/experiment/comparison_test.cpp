// Which natural motion is compared with.
#include "experiment/comparison.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

const std::vector<std::string> kNames = {"dataset-2_walk_active_001", "dataset-2_walk_active_017",
                                         "dataset-2_run_active_001", "dataset-2_walk_old_003"};

TEST(Comparison, AStyleIsANameWithoutItsNumber) {
  EXPECT_EQ(styleOf("dataset-2_walk_active_001"), "dataset-2_walk_active");
  EXPECT_EQ(styleOf("run-17"), "run");
  EXPECT_EQ(styleOf("walk"), "walk");
  EXPECT_EQ(styleOf("012"), "012");
}

TEST(Comparison, TakesTheSameControlTheSameStyleOrAll) {
  const std::vector<int> follows = {1, 1, 3, -1};
  const auto control = naturalToCompare(kNames, follows, NaturalChoice::SameControl);
  EXPECT_EQ(control.clips, (std::vector<size_t>{1, 3}));
  EXPECT_EQ(control.leftOut, 2U);
  EXPECT_EQ(control.text, "the 2 of 4 natural clips whose control was followed");
  const auto style = naturalToCompare(kNames, follows, NaturalChoice::SameStyle);
  EXPECT_EQ(style.clips, (std::vector<size_t>{0, 1, 3}));
  const auto all = naturalToCompare(kNames, follows, NaturalChoice::All);
  EXPECT_EQ(all.clips.size(), 4U);
  EXPECT_EQ(all.text, "all 4 natural clips");
}

TEST(Comparison, OfMotionsAlongNoNaturalControlIsWithAllOrRefused) {
  EXPECT_EQ(naturalToCompare(kNames, {-1}, NaturalChoice::All).clips.size(), 4U);
  EXPECT_THROW(naturalToCompare(kNames, {-1}, NaturalChoice::SameControl), UsageError);
  EXPECT_THROW(naturalToCompare(kNames, {}, NaturalChoice::SameStyle), UsageError);
}

TEST(Comparison, KnowsItsWords) {
  for (const auto choice :
       {NaturalChoice::SameControl, NaturalChoice::SameStyle, NaturalChoice::All})
    EXPECT_EQ(naturalChoiceByName(nameOf(choice)), choice);
  EXPECT_THROW(naturalChoiceByName("some"), UsageError);
}

TEST(Comparison, ADocumentKeepsTheChoiceAndRefusesOtherWords) {
  Experiment e;
  e.against = "same-style";
  EXPECT_EQ(experimentFromJson(toJson(e), "test").against, "same-style");
  EXPECT_FALSE(toJson(Experiment()).contains("against"));
  Json other = toJson(e);
  other["against"] = "nobody";
  EXPECT_THROW(experimentFromJson(other, "test"), InputError);
}

TEST(Comparison, HeldOutMotionsFollowNaturalClipsInOrder) {
  Experiment e;
  e.heldOutSamples = 2;
  SystemResult system;
  system.heldOut.resize(4);
  EXPECT_EQ(heldOutControls(system, e), (std::vector<int>{0, 0, 1, 1}));
}

}  // namespace
}  // namespace marey

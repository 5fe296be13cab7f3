#include "experiment/kept_sets.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

KeptSet walkSet() {
  return {.system = {.name = "A", .model = "models/a.marey", .temperature = 0.9},
          .path = {.name = "left", .path = "preset:turn-left", .seconds = 3.0},
          .samples = 4,
          .seed = 7,
          .hidden = {}};
}

TEST(KeptSets, NameTheSameFilesFromAnotherFolder) {
  EXPECT_EQ(inFolder(walkSet(), "/x/first", "/x").system.model, "first/models/a.marey");
  // A way up and down again is harder to read and no more lasting than a whole one.
  const KeptSet beside = inFolder(walkSet(), "/x/first", "/x/second");
  EXPECT_EQ(beside.system.model, "/x/first/models/a.marey");
  EXPECT_EQ(inFolder(walkSet(), "/x/first", "/x/first").system.model, "models/a.marey");
  const SampleRecipe recipe = inFolder(recipeOf(walkSet(), 20.0, "/x/first"), "/x/second");
  EXPECT_EQ(recipe.system.model, "/x/first/models/a.marey");
  EXPECT_EQ(recipe.folder, "/x/second");
  EXPECT_EQ(recipe.seed, 7U);
}

TEST(KeptSets, AreToldApartByHowTheyAreMadeAndWhatIsLeftOut) {
  const std::string key = keyOf(walkSet());
  EXPECT_EQ(keyOf(walkSet()), key);
  KeptSet other = walkSet();
  other.seed = 8;
  EXPECT_NE(keyOf(other), key);
  other = walkSet();
  other.system.temperature = 1.0;
  EXPECT_NE(keyOf(other), key);
  other = walkSet();
  other.leftOut = {2};
  EXPECT_NE(keyOf(other), key);
  other = walkSet();
  other.hidden = {2};
  EXPECT_EQ(keyOf(other), key) << "what is hidden changes nothing but pictures";
}

TEST(KeptSets, ThatNoDocumentCouldOpenAreNotKept) {
  EXPECT_TRUE(canBeKept(walkSet()));
  KeptSet nowhere = walkSet();
  nowhere.path.path.clear();
  nowhere.path.wayPoints = {{.x = 0, .z = 0, .timeS = {}, .speedMS = {}, .facing = {}}};
  EXPECT_FALSE(canBeKept(nowhere));
}

}  // namespace
}  // namespace marey

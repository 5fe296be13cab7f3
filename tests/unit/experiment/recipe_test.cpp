#include "experiment/recipe.h"

#include <map>

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(Recipe, AValueThatAllSamplesShareStandsUnderTheBareKey) {
  const RecipeText text = recipeOf("e1", {{"Natural", {}, "6"},
                                          {"MG", SampleOrigin{"m1", 7, 0.8}, "2"},
                                          {"MG+", SampleOrigin{"m2", 7, 1.0}, "3"}});
  const std::map<std::string, std::string> told(text.begin(), text.end());
  EXPECT_EQ(told.size(), text.size()) << "a key came twice";
  EXPECT_EQ(told.at("experiment_hash"), "e1");
  EXPECT_FALSE(told.at("marey").empty());
  EXPECT_EQ(told.at("seed"), "7");
  EXPECT_FALSE(told.contains("model_hash"));
  EXPECT_EQ(told.at("model_hash MG"), "m1");
  EXPECT_EQ(told.at("temperature MG"), "0.8");
  EXPECT_EQ(told.at("motions Natural"), "6");
  EXPECT_FALSE(told.contains("seed Natural"));
}

TEST(Recipe, AMotionHasTheSameKeysAsAPicture) {
  const SampleOrigin origin{"m1", 7, 0.8};
  const Json motion = motionRecipe("e1", origin);
  const RecipeText picture = recipeOf("e1", {{"MG", origin, "1"}});
  const std::map<std::string, std::string> told(picture.begin(), picture.end());
  for (const auto& [key, value] : motion.items()) EXPECT_TRUE(told.contains(key)) << key;
  EXPECT_EQ(motion.size(), 5U);
  EXPECT_EQ(motionRecipe("e1", {}).size(), 2U);
  EXPECT_FALSE(motionRecipe("", origin).contains("experiment_hash"));
}

}  // namespace
}  // namespace marey

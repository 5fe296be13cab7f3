// What the makers of a model advise, in its file and beside it.
#include "model/model_card.h"

#include "../base/support.h"
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/tensor_file.h"

namespace marey {
namespace {

using test::TempFolder;

void writeModel(const std::filesystem::path& path, const Json& metadata) {
  TensorFile file;
  file.metadata = metadata;
  writeTensorFile(path, file);
}

TEST(ModelAdvice, IsReadFromTheModelAndPassedOn) {
  const TempFolder folder;
  writeFileAtomically(folder / "m.card.md", "beside it");
  writeModel(folder / "m.marey",
             {{"card", "# Tiny\nWalks."}, {"recommended", {{"temperature", 0.75}}}});
  const ModelAdvice advice = modelAdvice(folder / "m.marey");
  EXPECT_EQ(advice.card, "# Tiny\nWalks.");
  EXPECT_TRUE(advice.cardFile.empty());
  EXPECT_EQ(advice.temperature, 0.75);
  Json metadata = {{"kind", "model"}};
  passAdviceOn(folder / "m.marey", metadata);
  storeAdvice(metadata, {}, 0.5);
  writeModel(folder / "smaller.marey", metadata);
  EXPECT_EQ(modelAdvice(folder / "smaller.marey").card, "# Tiny\nWalks.");
  EXPECT_EQ(modelAdvice(folder / "smaller.marey").temperature, 0.5);
}

TEST(ModelAdvice, OfAModelWithoutACardHasTheOneThatLiesBesideIt) {
  const TempFolder folder;
  writeModel(folder / "m.marey", Json::object());
  EXPECT_EQ(modelAdvice(folder / "m.marey").card, "");
  EXPECT_FALSE(modelAdvice(folder / "m.marey").temperature);
  writeFileAtomically(folder / "MODEL_CARD.md", "of the folder");
  EXPECT_EQ(modelAdvice(folder / "m.marey").card, "of the folder");
  writeFileAtomically(folder / "m.card.md", "its own");
  EXPECT_EQ(modelAdvice(folder / "m.marey").card, "its own");
  EXPECT_EQ(modelAdvice(folder / "m.marey").cardFile, folder / "m.card.md");
  Json metadata = Json::object();
  passAdviceOn(folder / "m.marey", metadata);
  EXPECT_TRUE(metadata.empty()) << "a file beside a model is not the model's";
}

TEST(ModelAdvice, ThatIsNotUnderstoodIsRefusedByItsName) {
  const TempFolder folder;
  const auto refusal = [&](const Json& recommended) {
    writeModel(folder / "odd.marey", {{"recommended", recommended}});
    return test::messageOf<InputError>([&] { modelAdvice(folder / "odd.marey"); });
  };
  EXPECT_NE(refusal({{"temprature", 1.0}}).find("recommended.temprature"), std::string::npos);
  EXPECT_NE(refusal({{"temperature", -1.0}}).find("at least 0"), std::string::npos);
  EXPECT_NE(refusal({{"temperature", "warm"}}).find("odd.marey"), std::string::npos);
}

}  // namespace
}  // namespace marey

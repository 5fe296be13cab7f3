// Which weights of a checkpoint are the network's.
#include "pickle/state_dicts.h"

#include "unit/base/support.h"
#include <gtest/gtest.h>

namespace marey {
namespace {

using test::messageOf;

/// Names of the network begin with "enc.".
size_t ownName(std::string_view key) {
  for (size_t at = key.find("enc."); at != std::string_view::npos; at = key.find("enc.", at + 1))
    if (at == 0 || key[at - 1] == '.') return at;
  return std::string_view::npos;
}

TorchCheckpoint checkpoint(const std::map<std::string, float>& values) {
  TorchCheckpoint out;
  for (const auto& [path, value] : values)
    if (stateDictFilter(ownName)(path))
      out.tensors[path] = Tensor::fromFloats({1}, &value);
    else
      out.skipped.push_back(path);
  return out;
}

StateDict choose(const std::map<std::string, float>& values, const std::string& wanted = "") {
  return chooseStateDict(checkpoint(values), ownName, "enc.w", wanted, "a.pt");
}

std::string refusal(const std::map<std::string, float>& values, const std::string& wanted = "") {
  return messageOf<InputError>([&] { choose(values, wanted); });
}

TEST(StateDicts, AreFoundUnderAnyDictionaryAndAnyOrderOfWrappers) {
  for (const std::string path :
       {"enc.w", "graph/enc.w", "state_dict/model.enc.w", "module._orig_mod.enc.w",
        "a/b/_orig_mod.module.net.enc.w", "x/model.model.enc.w"}) {
    const StateDict state = choose({{path, 3.0f}});
    ASSERT_TRUE(state.tensors.contains("enc.w")) << path;
    EXPECT_EQ(state.tensors.at("enc.w").toFloats(), std::vector<float>{3.0f});
    EXPECT_TRUE(state.leftOut.empty());
  }
  EXPECT_EQ(choose({{"enc.w", 1}}).name, ".");
  EXPECT_EQ(choose({{"a/b/module.enc.w", 1}}).name, "a/b/module");
}

TEST(StateDicts, AreNotTheStateOfAnOptimiserWithTheSameNames) {
  for (const char* folder : {"optimizer", "optim", "opt", "optimizer_states/0", "Adam/state",
                             "x/exp_avg", "opt_state", "ema_grads/grad"}) {
    const StateDict state = choose({{"graph/enc.w", 1.0f}, {std::string(folder) + "/enc.w", 2.0f}});
    EXPECT_EQ(state.name, "graph") << folder;
    EXPECT_EQ(state.leftOut.size(), 1u);
  }
}

TEST(StateDicts, OfWhichThereAreTwoMustBeChosen) {
  const std::map<std::string, float> two = {
      {"graph/enc.w", 1}, {"graph/enc.b", 2}, {"graph_ema/enc.w", 3}, {"graph_ema/enc.b", 4}};
  EXPECT_NE(refusal(two).find("two state dicts: graph, graph_ema; choose one"), std::string::npos);
  const StateDict state = choose(two, "graph_ema");
  EXPECT_EQ(state.tensors.at("enc.w").toFloats(), std::vector<float>{3});
  EXPECT_EQ(state.tensors.at("enc.b").toFloats(), std::vector<float>{4});
  EXPECT_EQ(state.leftOut, std::vector<std::string>{"graph (2 tensors)"});
  EXPECT_NE(refusal(two, "other").find("graph, graph_ema"), std::string::npos);
}

TEST(StateDicts, InOneDictionaryDifferByTheirPrefix) {
  const std::map<std::string, float> two = {{"state_dict/model.enc.w", 1},
                                            {"state_dict/model_ema.enc.w", 2}};
  EXPECT_NE(refusal(two).find("state_dict/model, state_dict/model_ema"), std::string::npos);
  EXPECT_EQ(choose(two, "state_dict/model_ema").tensors.at("enc.w").toFloats(),
            std::vector<float>{2});
  // The dictionary holds both, so that its name alone says nothing.
  EXPECT_FALSE(refusal(two, "state_dict").empty());
  EXPECT_EQ(choose({{"ema/module.enc.w", 2}, {"net/enc.w", 1}}, "ema").name, "ema/module");
}

TEST(StateDicts, ThatAreTheSameBitForBitAreOne) {
  const StateDict state = choose({{"best/enc.w", 5}, {"last/enc.w", 5}});
  EXPECT_EQ(state.tensors.at("enc.w").toFloats(), std::vector<float>{5});
  EXPECT_FALSE(refusal({{"best/enc.w", 5}, {"last/enc.w", 6}}).empty());
  EXPECT_FALSE(refusal({{"best/enc.w", 5}, {"best/enc.b", 5}, {"last/enc.w", 5}}).empty());
}

TEST(StateDicts, WithAnUnknownPrefixAreShownAndTakenByName) {
  const std::string message = refusal({{"sd/backbone.enc.w", 1}});
  EXPECT_NE(message.find("'enc.w'"), std::string::npos) << message;
  EXPECT_NE(message.find("'sd/backbone.enc.w'"), std::string::npos) << message;
  EXPECT_EQ(choose({{"sd/backbone.enc.w", 1}}, "sd/backbone").tensors.size(), 1u);
}

TEST(StateDicts, OfAnotherNetworkAreShown) {
  const std::string message = refusal({{"sd/conv.weight", 1}});
  EXPECT_NE(message.find("'enc.w'"), std::string::npos) << message;
  EXPECT_NE(message.find("'sd/conv.weight'"), std::string::npos) << message;
  EXPECT_NE(refusal({}).find("no tensor"), std::string::npos);
}

TEST(StateDicts, SayWhatElseThereIs) {
  const StateDict state =
      choose({{"g/enc.w", 1}, {"g/other.w", 2}, {"d/a", 3}, {"optim/0/x", 4}, {"optim/1/x", 5}});
  EXPECT_EQ(state.leftOut, (std::vector<std::string>{"d/a", "g/other.w", "optim (2 tensors)"}));
}

}  // namespace
}  // namespace marey

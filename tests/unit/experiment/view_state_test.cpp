// How an experiment was looked at, as its document keeps it.
#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"
#include "experiment/edits.h"
#include "experiment/sample_set.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

Steering steered() {
  Steering out;
  out.options.sample = 3;
  out.options.begin.forwardMS = 1.25;
  out.options.start = {.x = 1.0, .z = -2.0, .heading = 0.5};
  out.commands.assign(40, {.forwardMS = 1.25});
  out.commands.resize(60, {.forwardMS = 0.5, .turnRadS = -0.25});
  return out;
}

ViewState everything() {
  ViewState out;
  out.path = "circle";
  out.notSampled = {"MG"};
  out.natural = {{"walks", {0, 7}}, {"run.bvh", {}}};
  out.comparison = Comparison::HeldOut;
  out.scene.colourBy = 2;
  out.scene.placement = 1;
  out.scene.trails = 2;
  out.scene.ghostsS = 0.5;
  out.scene.naturalUnder = "MG";
  out.scene.shadow = false;
  out.camera = CameraPose{{1, 2, 3}, {0, 1, 0}, {0, 1, 0}, 2.5, true};
  out.follow = true;
  out.cameras[4] = CameraPose{};
  out.trainingRun = "runs/a";
  out.sets.push_back({.system = {"step 40", "runs/a/checkpoints/step_0000040.marey", 0.7},
                      .path = {.name = "circle", .path = "preset:circle", .seconds = 4.0},
                      .samples = 5,
                      .seed = 18446744073709551615U,
                      .pinned = true,
                      .colour = 12,
                      .hidden = {1, 4}});
  out.sets.push_back({.system = {"MG", "a.marey", 1.0},
                      .path = {.name = "live", .path = "preset:still"},
                      .steering = steered(),
                      .hidden = {}});
  return out;
}

Experiment lookedAt() {
  Experiment out;
  out.natural = {"walks", "run.bvh"};
  out.systems = {{"MG", "a.marey", 0.8}};
  out.paths = {{.name = "circle", .path = "preset:circle"}};
  out.view = everything();
  return out;
}

std::string refusal(const Json& view) {
  Json document = toJson(lookedAt());
  document["view"] = view;
  try {
    experimentFromJson(document, "x.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ViewState, IsTheSameAfterSavingAndOpening) {
  const Experiment back = asStored(lookedAt());
  EXPECT_EQ(toJson(back.view), toJson(everything()));
  // Not only the same text: the values that a window uses.
  EXPECT_EQ(back.view.sets[0].seed, 18446744073709551615U);
  EXPECT_EQ(back.view.sets[0].hidden, (std::vector<int>{1, 4}));
  EXPECT_EQ(back.view.natural, everything().natural);
  EXPECT_EQ(back.view.scene, everything().scene);
  EXPECT_EQ(back.view.camera, everything().camera);
  ASSERT_TRUE(back.view.sets[1].steering);
  EXPECT_EQ(back.view.sets[1].steering->commands, steered().commands);
  EXPECT_EQ(back.view.sets[1].steering->options.start.heading, 0.5);
}

TEST(ViewState, DecidesNoNumber) {
  Experiment plain = lookedAt();
  plain.view = {};
  EXPECT_EQ(experimentHash(plain), experimentHash(lookedAt()));
  EXPECT_EQ(plain, lookedAt());
  EXPECT_FALSE(toJson(plain).contains("view"));
}

TEST(ViewState, ADocumentWithoutOneOpensAsBefore) {
  Json document = toJson(lookedAt());
  document.erase("view");
  const Experiment read = experimentFromJson(document, "old.json");
  EXPECT_TRUE(toJson(read.view).empty());
  EXPECT_FALSE(read.view.natural) << "no clip would be shown";
}

/// A document that uses every reader of its parts.
Json wholeDocument() {
  Experiment out = lookedAt();
  out.systems[0].options = {{"decoder_noise", 0.0}};
  out.paths.push_back({.name = "drawn",
                       .path = {},
                       .wayPoints = {{.x = 0, .z = 0, .timeS = {}, .speedMS = {}, .facing = {}},
                                     {.x = 0, .z = 2, .timeS = {}, .speedMS = {}, .facing = {}}},
                       .seconds = 0.0});
  return toJson(out);
}

/// Every object of a document, but for those whose keys are free.
void forObjects(const Json& value, const std::string& place,
                const std::function<void(const std::string&)>& visit) {
  if (place.ends_with("/options") || place.ends_with("/cameras")) return;
  if (value.is_object()) visit(place);
  if (value.is_structured())
    for (const auto& [key, child] : value.items()) forObjects(child, place + "/" + key, visit);
}

TEST(Document, AMisspeltKeyIsRefusedInEveryPartOfIt) {
  const Json whole = wholeDocument();
  EXPECT_NO_THROW(experimentFromJson(whole, "x.json"));
  int parts = 0;
  forObjects(whole, "", [&](const std::string& place) {
    Json broken = whole;
    broken[Json::json_pointer(place)]["misspelt"] = 1;
    try {
      experimentFromJson(broken, "x.json");
      ADD_FAILURE() << place << "/misspelt passes";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("misspelt"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("x.json"), std::string::npos) << error.what();
    }
    ++parts;
  });
  // The document, its systems, paths, way-points, view, cameras, sets, steering and runs.
  EXPECT_GE(parts, 20);
}

TEST(Document, OfANewerVersionIsRefusedAndOneWithoutAVersionIsRead) {
  Json document = wholeDocument();
  EXPECT_EQ(document.at("version"), 1);
  const Experiment now = experimentFromJson(document, "x.json");
  document.erase("version");
  EXPECT_EQ(experimentFromJson(document, "x.json"), now);
  EXPECT_EQ(experimentHash(experimentFromJson(document, "x.json")), experimentHash(now));
  document["version"] = 2;
  try {
    experimentFromJson(document, "x.json");
    ADD_FAILURE() << "a newer version passes";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "x.json, key 'version': expected a version from 1 to 1 (a newer Marey wrote this), "
              "found 2");
  }
}

TEST(Options, OfASystemAreStoredAndCount) {
  Experiment plain = lookedAt(), given = lookedAt();
  given.systems[0].options = {{"decoder_noise", 0.0}, {"style", 0.5}};
  EXPECT_EQ(asStored(given).systems[0].options, given.systems[0].options);
  EXPECT_NE(experimentHash(given), experimentHash(plain));
  EXPECT_FALSE(toJson(plain)["systems"][0].contains("options"));
  Json document = toJson(given);
  document["systems"][0]["options"]["style"] = "much";
  EXPECT_THROW(experimentFromJson(document, "x.json"), InputError);
  document["systems"][0]["options"] = {{"temperature", 0.5}};
  EXPECT_THROW(experimentFromJson(document, "x.json"), InputError);
}

TEST(ViewState, WhatIsNotKnownIsRefusedByItsName) {
  const Json whole = toJson(everything());
  EXPECT_EQ(refusal(whole), "");
  const auto without = [&](const char* place, const Json& value) {
    Json view = whole;
    view[Json::json_pointer(place)] = value;
    return refusal(view);
  };
  const auto names = [](const std::string& message, const char* part) {
    return message.find(part) != std::string::npos;
  };
  EXPECT_PRED2(names, without("/colour", 1), "view.colour");
  EXPECT_PRED2(names, without("/scene/colour_by", "mood"), "system, sample, likelihood, speed");
  EXPECT_PRED2(names, without("/scene/shadows", true), "view.scene.shadows");
  EXPECT_PRED2(names, without("/camera/eye", {1, 2}), "view.camera.eye");
  EXPECT_PRED2(names, without("/camera/target", everything().camera->eye), "view.camera.target");
  EXPECT_PRED2(names, without("/cameras/12", whole["camera"]), "view.cameras");
  EXPECT_PRED2(names, without("/sets/0/samples", 0), "view.sets[0].samples");
  EXPECT_PRED2(names, without("/sets/0/system/modell", "x"), "view.sets[0].system.modell");
  EXPECT_PRED2(names, without("/sets/1/steering/commands/0/frames", 0),
               "view.sets[1].steering.commands[0].frames");
  EXPECT_PRED2(names, without("/natural/0/clip", 0), "view.natural[0].clip");
}

TEST(ViewState, ARecipeComesBackFromItsSet) {
  const SampleRecipe recipe = recipeOf(everything().sets[1], 20.0, "/data");
  EXPECT_EQ(toJson(keptSetOf(recipe))["steering"], toJson(everything().sets[1])["steering"]);
  EXPECT_EQ(recipe.folder, "/data");
  EXPECT_EQ(recipe.fps, 20.0);
}

TEST(MovingTheDocument, NamesWhatLiesBesideItRelativelyAndTheRestWhole) {
  Experiment e = lookedAt();
  e.folder = "/study";
  e.natural = {"/study/walks",     "run.bvh",      "/elsewhere/run.bvh",
               "@/study/list.txt", "walker:2,2,1", "/studying/a.bvh"};
  e.systems[0].model = "/study/models/a.marey";
  e.paths[0].path = "clip:/study/walks/a.bvh";
  e.view.natural->front().source = "/study/walks";
  e.view.sets[0].system.model = "/study/runs/step.marey";
  e.view.trainingRun = "/study/runs";
  moveToFolder(e, "/study");
  EXPECT_EQ(e.natural, (std::vector<std::string>{"walks", "run.bvh", "/elsewhere/run.bvh",
                                                 "@list.txt", "walker:2,2,1", "/studying/a.bvh"}));
  EXPECT_EQ(e.systems[0].model, "models/a.marey");
  EXPECT_EQ(e.paths[0].path, "clip:walks/a.bvh");
  EXPECT_EQ(e.view.natural->front().source, "walks");
  EXPECT_EQ(e.view.sets[0].system.model, "runs/step.marey");
  EXPECT_EQ(e.view.trainingRun, "runs");
  moveToFolder(e, "/other");
  EXPECT_EQ(e.natural[0], "/study/walks");
  EXPECT_EQ(e.view.sets[0].system.model, "/study/runs/step.marey");
}

}  // namespace
}  // namespace marey

// Training runs and stored models.
#include "model/gradient/trainer.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "tiny_run.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "model/gradient/kept_checkpoints.h"
#include "model/training_pace.h"

namespace marey {
namespace {

using test::TempFolder;

// ---- Stored models

TEST(StoredModel, LoadsWithItsFactsAndSavesTheSameTensors) {
  const TempFolder folder;
  writeTensorFile(folder / "m.marey", test::tinyFile());
  const auto model = loadModel((folder / "m.marey").string(), test::families());
  EXPECT_EQ(model->info().variant, "tiny");
  EXPECT_EQ(model->info().context, 3);
  EXPECT_EQ(model->info().lookahead, 1);
  EXPECT_EQ(model->info().poseDim, 63);
  EXPECT_EQ(*model->info().skeleton, *walkerSkeleton());
  EXPECT_EQ(model->info().provenance["steps"], 3);
  const TensorFile saved = model->save();
  ASSERT_EQ(saved.tensors.size(), test::tinyFile().tensors.size());
  for (const auto& [name, tensor] : saved.tensors)
    EXPECT_EQ(tensor.bytes, test::tinyFile().tensors.at(name).bytes) << name;
}

const std::string kBias = "weights/flow.step1_actnorm.bias";

/// The message with which a damaged model is refused.
std::string refusal(const std::function<void(TensorFile&)>& damage) {
  const TempFolder folder;
  TensorFile file = test::tinyFile();
  damage(file);
  writeTensorFile(folder / "damaged.marey", file);
  return test::messageOf<InputError>(
      [&] { loadModel((folder / "damaged.marey").string(), test::families()); });
}

void expectNames(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_NE(message.find("damaged.marey"), std::string::npos) << message;
}

TEST(StoredModel, OfANewerVersionIsRefusedAndOneWithoutAVersionIsRead) {
  const std::string message = refusal([](TensorFile& f) { f.metadata["version"] = 99; });
  expectNames(message, "key 'version'");
  expectNames(message, "from 1 to 1");
  expectNames(message, "99");
  expectNames(refusal([](TensorFile& f) { f.metadata["version"] = "new"; }), "version");
  const TempFolder folder;
  TensorFile old = test::tinyFile();
  EXPECT_EQ(old.metadata.at("version"), 1);
  old.metadata.erase("version");
  writeTensorFile(folder / "old.marey", old);
  EXPECT_EQ(loadModel((folder / "old.marey").string(), test::families())->info().variant, "tiny");
}

TEST(Configuration, WithAMisspeltKeyOrOfANewerVersionIsRefused) {
  const auto refused = [](const Json& change, const char* part) {
    Json config = test::tinyConfig();
    config.update(change);
    const auto message =
        test::messageOf<InputError>([&] { familyOf(config, test::families(), "mine.json"); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("mine.json"), std::string::npos) << message;
  };
  refused({{"trainning", Json::object()}}, "trainning");
  refused({{"version", 2}}, "from 1 to 1");
  refused({{"version", "1"}}, "version");
  EXPECT_EQ(familyOf(test::tinyConfig(), test::families(), "mine.json").name, "moglow");
}

TEST(Trainer, AStateOfANewerVersionIsRefusedAndOneWithoutAVersionGoesOn) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.steps = 1;
  test::trainTiny(request);
  request.resume = true;
  request.steps = 2;
  const auto path = folder / "run" / "state.marey";
  TensorFile state = readTensorFile(path);
  state.metadata["version"] = 99;
  writeTensorFile(path, state);
  const auto message = test::messageOf<InputError>([&] { test::trainTiny(request); });
  EXPECT_NE(message.find("state.marey"), std::string::npos) << message;
  EXPECT_NE(message.find("from 1 to 1"), std::string::npos) << message;
  // As runs were kept before there were versions, optimisers and options of inputs.
  state.metadata.erase("version");
  for (const char* key : {"optimiser", "input_noise", "input_dropout"})
    state.metadata["identity"]["training"].erase(key);
  writeTensorFile(path, state);
  EXPECT_EQ(test::trainTiny(request).steps, 2);
}

TEST(TrainingPace, HoldsItsSharesOfTheFrames) {
  const TrainingPace pace = trainingPace(test::tinyData().train, 20.0);
  std::vector<double> speeds;
  for (const FeatureSequence& s : test::tinyData().train)
    for (long t = 0; t < s.control.rows(); ++t)
      speeds.push_back(20.0 * std::hypot(s.control(t, 0), s.control(t, 1)));
  const auto share = [&](double below) {
    const auto count =
        std::count_if(speeds.begin(), speeds.end(), [&](double v) { return v < below; });
    return static_cast<double>(count) / static_cast<double>(speeds.size());
  };
  EXPECT_NEAR(share(pace.speedMS.lowest), 0.005, 0.01);
  EXPECT_NEAR(share(pace.speedMS.low), 0.05, 0.01);
  EXPECT_NEAR(share(pace.speedMS.high), 0.95, 0.01);
  EXPECT_NEAR(share(pace.speedMS.highest), 0.995, 0.01);
  // Mirrored motion turns as far to the right as to the left.
  EXPECT_NEAR(pace.turnRadS.lowest, -pace.turnRadS.highest, 0.02);
  EXPECT_GT(pace.turnRadS.highest, pace.turnRadS.high);
  EXPECT_THROW(trainingPace({}, 20.0), NumericError);
}

TEST(StoredModel, KnowsThePaceOfItsTrainingData) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.config["training"]["validation_share"] = 0.0;
  request.steps = 1;
  EXPECT_EQ(readTrainingPace(test::trainTiny(request).last),
            trainingPace(test::tinyData().train, 20.0));
}

TEST(StoredModel, WithoutAPaceHasNoneAndABrokenOneIsRefused) {
  const TempFolder folder;
  const auto file = folder / "tiny.marey";
  TensorFile stored = test::tinyFile();
  stored.metadata["provenance"]["training_pace"]["speed_m_s"] = {0.5, 0.1, 1.0, 2.0};
  writeTensorFile(file, stored);
  EXPECT_THROW(readTrainingPace(file), InputError);
  stored.metadata["provenance"].erase("training_pace");
  writeTensorFile(file, stored);
  EXPECT_FALSE(readTrainingPace(file).has_value());
  std::ofstream(file) << "short";
  EXPECT_THROW(readTrainingPace(file), InputError);
  EXPECT_THROW(readTrainingPace(folder / "none.marey"), FileError);
}

TEST(StoredModel, AMissingTensorIsRefused) {
  expectNames(refusal([](TensorFile& f) { ASSERT_EQ(f.tensors.erase(kBias), 1u); }),
              "flow.step1_actnorm.bias");
}

TEST(StoredModel, AnExtraTensorIsRefused) {
  expectNames(refusal([](TensorFile& f) { f.tensors["weights/flow.more"] = f.tensors.at(kBias); }),
              "flow.more");
}

TEST(StoredModel, ATensorOfAnotherShapeIsRefused) {
  const std::vector<float> values(62, 0.f);
  expectNames(
      refusal([&](TensorFile& f) { f.tensors[kBias] = Tensor::fromFloats({62}, values.data()); }),
      "flow.step1_actnorm.bias");
}

TEST(StoredModel, ANonFiniteWeightIsRefused) {
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    std::vector<float> values(63, 0.f);
    values[17] = bad;
    expectNames(
        refusal([&](TensorFile& f) { f.tensors[kBias] = Tensor::fromFloats({63}, values.data()); }),
        "flow.step1_actnorm.bias");
  }
}

TEST(StoredModel, AStandardDeviationOfZeroIsRefused) {
  std::vector<float> values(63, 1.f);
  values[5] = 0.f;
  expectNames(refusal([&](TensorFile& f) {
                f.tensors["standardiser/pose_std"] = Tensor::fromFloats({63}, values.data());
              }),
              "pose_std");
}

TEST(StoredModel, AnotherFamilyOrKindIsRefused) {
  expectNames(refusal([](TensorFile& f) { f.metadata["family"] = "diffusion"; }), "diffusion");
  expectNames(refusal([](TensorFile& f) { f.metadata["kind"] = "dataset"; }), "dataset");
}

TEST(StoredModel, AConfigurationOfOtherWidthsIsRefused) {
  expectNames(refusal([](TensorFile& f) { f.metadata["config"]["pose_dim"] = 60; }), "60");
  EXPECT_FALSE(refusal([](TensorFile& f) { f.metadata["config"]["hidden"] = 9; }).empty());
}

TEST(StoredModel, ACutFileIsRefused) {
  const TempFolder folder;
  const std::string whole = serialise(test::tinyFile());
  for (const size_t size : {size_t{0}, size_t{7}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(folder / "cut.marey", std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(loadModel((folder / "cut.marey").string(), test::families()), InputError) << size;
  }
  EXPECT_THROW(loadModel((folder / "none.marey").string(), test::families()), FileError);
}

// ---- Runs

/// Rows of a run's log without the column of wall-clock seconds.
std::vector<std::string> logRows(const std::filesystem::path& run) {
  std::istringstream in(test::slurp(run / "log.csv"));
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) {
    const size_t first = line.find(','), second = line.find(',', first + 1);
    out.push_back(line.substr(0, first) + line.substr(second));
  }
  return out;
}

TEST(Trainer, ABrokenAndResumedRunIsTheSameAsAnUnbrokenOne) {
  const TempFolder folder;
  const auto whole = test::trainTiny(test::tinyRequest(folder / "whole"));
  TrainRequest first = test::tinyRequest(folder / "broken");
  first.steps = 3;
  EXPECT_EQ(test::trainTiny(first).steps, 3);
  TrainRequest second = test::tinyRequest(folder / "broken");
  second.resume = true;
  const auto resumed = test::trainTiny(second);
  EXPECT_EQ(resumed.steps, 6);
  const auto a = readTensorFile(whole.last), b = readTensorFile(resumed.last);
  ASSERT_EQ(a.tensors.size(), b.tensors.size());
  for (const auto& [name, tensor] : a.tensors) EXPECT_EQ(tensor.bytes, b.tensors.at(name).bytes);
  EXPECT_NE(a.tensors.at(kBias).bytes, test::tinyFile().tensors.at(kBias).bytes) << "no training";
  EXPECT_EQ(logRows(folder / "whole"), logRows(folder / "broken"));
  EXPECT_EQ(logRows(folder / "whole").size(), 3u);  // header and two checkpoints
  EXPECT_EQ(whole.valid, resumed.valid);
  EXPECT_EQ(whole.testNatsPerFrame, resumed.testNatsPerFrame);
}

std::vector<std::string> keptFiles(const std::filesystem::path& run) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(run / "checkpoints"))
    out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

TEST(KeptCheckpoints, AreEvenlySpreadAndNeverMoreThanAskedFor) {
  for (const int keep : {1, 2, 3, 8})
    for (int64_t count = 1; count <= 300; ++count) {
      const int64_t kept = count / keptEvery(count, keep);
      EXPECT_LE(kept, keep) << count;
      EXPECT_GE(2 * kept, std::min<int64_t>(keep, count)) << count << " thinned too much";
    }
}

TEST(KeptCheckpoints, OfALongerRunAreThinnedAndThoseOfAResumedRunAreTheSame) {
  const TempFolder folder;
  TrainRequest whole = test::tinyRequest(folder / "whole");
  whole.config["training"]["checkpoint_every"] = 1;
  whole.config["training"]["keep"] = 3;
  TrainRequest broken = whole;
  broken.run = folder / "broken";
  test::trainTiny(whole);
  EXPECT_EQ(
      keptFiles(whole.run),
      (std::vector<std::string>{"step_0000002.marey", "step_0000004.marey", "step_0000006.marey"}));
  broken.steps = 3;
  test::trainTiny(broken);
  EXPECT_EQ(
      keptFiles(broken.run),
      (std::vector<std::string>{"step_0000001.marey", "step_0000002.marey", "step_0000003.marey"}));
  broken.steps.reset();
  broken.resume = true;
  test::trainTiny(broken);
  EXPECT_EQ(keptFiles(broken.run), keptFiles(whole.run));
  // Each is the model of its step, with its figures.
  const auto kept =
      loadModel((whole.run / "checkpoints/step_0000004.marey").string(), test::families());
  EXPECT_EQ(kept->info().provenance["steps"], 4);
  EXPECT_TRUE(std::isfinite(kept->info().provenance["valid_nats_per_frame"].get<double>()));
  EXPECT_EQ(logRows(whole.run).size(), 7u) << "figures of every checkpoint";
}

TEST(Trainer, TrainingMakesTheDataMoreLikely) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.config["training"]["steps"] = 30;
  request.config["training"]["checkpoint_every"] = 10;
  request.config["training"]["ema"] = 0.0;
  request.config["model"]["dropout"] = 0.0;
  test::trainTiny(request);
  std::vector<double> bits;
  for (const auto& row : logRows(folder / "run")) {
    if (row.starts_with("step")) continue;
    std::istringstream in(row);
    std::string field;
    for (int i = 0; i < 3; ++i) std::getline(in, field, ',');
    bits.push_back(std::stod(field));
  }
  ASSERT_EQ(bits.size(), 3u);
  EXPECT_LT(bits[1], bits[0]);
  EXPECT_LT(bits[2], bits[1]);
}

TEST(Trainer, AFolderWithARunIsRefusedWithoutResume) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.steps = 1;
  test::trainTiny(request);
  EXPECT_THROW(test::trainTiny(request), InputError);
}

TEST(Trainer, ResumingNothingOrAnotherRunIsRefused) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.resume = true;
  EXPECT_THROW(test::trainTiny(request), FileError);
  request.resume = false;
  request.steps = 1;
  test::trainTiny(request);
  request.resume = true;
  request.seed = 2;
  const auto message = test::messageOf<InputError>([&] { test::trainTiny(request); });
  EXPECT_NE(message.find("seed"), std::string::npos) << message;
}

TEST(Trainer, NonFiniteDataAreRefusedWithTheirClipAndFrame) {
  const TempFolder folder;
  DataSet data = test::tinyData();
  data.train[2].pose(5, 7) = std::nanf("");
  const auto message = test::messageOf<InputError>(
      [&] { test::trainTiny(test::tinyRequest(folder / "run"), data); });
  EXPECT_NE(message.find("'" + data.train[2].name + "'"), std::string::npos) << message;
  EXPECT_NE(message.find("frame 6"), std::string::npos) << message;
}

TEST(Trainer, ADivergingRunEndsWithTheNameOfALayer) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.config["training"]["learning_rate"] = 1e30;
  request.config["training"]["schedule"] = "fixed";
  request.config["training"]["steps"] = 20;
  const auto message = test::messageOf<NumericError>([&] { test::trainTiny(request); });
  EXPECT_NE(message.find("5 steps"), std::string::npos) << message;
  EXPECT_NE(message.find("flow.step"), std::string::npos) << message;
}

TEST(Trainer, AStoppedRunLeavesACheckpointToGoOnFrom) {
  const TempFolder folder;
  std::stop_source stop;
  Progress progress([&](double, std::string_view) { stop.request_stop(); }, stop.get_token());
  EXPECT_THROW(
      train(test::tinyData(), test::tinyRequest(folder / "run"), test::families(), progress),
      CancelledError);
  TrainRequest request = test::tinyRequest(folder / "run");
  request.resume = true;
  EXPECT_EQ(test::trainTiny(request).steps, 6);
}

TEST(Trainer, WindowsShorterThanTheContextAndUnknownDevicesAreRefused) {
  const TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.config["training"]["window_s"] = 0.2;
  EXPECT_THROW(test::trainTiny(request), InputError);
  request = test::tinyRequest(folder / "run");
  request.device = "abacus";
  EXPECT_THROW(test::trainTiny(request), UsageError);
}

}  // namespace
}  // namespace marey

// What nets are given in training: noise, hidden values, and their own poses (scheduled sampling).
#include <cmath>

#include "../unit/base/support.h"
#include "rnn/family.h"
#include "rnn/models.h"
#include "vae/net.h"
#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "model/gradient/build.h"
#include "model/gradient/input_noise.h"
#include "model/gradient/schedules.h"
#include "model/gradient/weights.h"
#include "moglow/net.h"
#include "motion/walker.h"

namespace marey {
namespace {

using torch::Tensor;

constexpr int64_t kPoses = 5, kControls = 2;

at::Generator generator(uint64_t seed) {
  return at::detail::createCPUGenerator(seed);
}

TrainingBatch batchOf(int64_t windows, int64_t frames) {
  auto random = generator(3);
  return {torch::randn({windows, frames, kPoses}, random),
          torch::randn({windows, frames, kControls}, random), torch::ones({windows, frames})};
}

TrainingConfig configOf(const Json& training) {
  return trainingConfigFromJson(training, "c.json");
}

// ---- Noise and hidden values

TEST(InputNoise, IsDrawnOnInputsAloneWithTheStatedDeviation) {
  const TrainingBatch clean = batchOf(200, 40);
  TrainingBatch noisy = clean;
  auto random = generator(1);
  disturbInputs(configOf({{"input_noise", 0.3}}), random, noisy);
  EXPECT_TRUE(noisy.pose.equal(clean.pose)) << "what is to be foreseen changed";
  for (const Tensor& added : {noisy.seen - clean.pose, noisy.control - clean.control}) {
    const auto n = static_cast<double>(added.numel());
    // Five standard errors of a mean and of a deviation.
    EXPECT_NEAR(added.mean().item<double>(), 0.0, 5 * 0.3 / std::sqrt(n));
    EXPECT_NEAR(added.std().item<double>(), 0.3, 5 * 0.3 / std::sqrt(2 * n));
  }
}

TEST(InputDropout, PutsTheMeanInThePlaceOfTheStatedShare) {
  const TrainingBatch clean = batchOf(200, 40);
  TrainingBatch hidden = clean;
  auto random = generator(1);
  disturbInputs(configOf({{"input_dropout", 0.25}}), random, hidden);
  EXPECT_TRUE(hidden.pose.equal(clean.pose));
  for (const auto& [found, was] :
       {std::pair{hidden.seen, clean.pose}, {hidden.control, clean.control}}) {
    const Tensor gone = found.eq(0);
    EXPECT_TRUE(torch::where(gone, was, found).equal(was)) << "another value than the mean";
    const auto n = static_cast<double>(gone.numel());
    EXPECT_NEAR(gone.to(torch::kFloat64).mean().item<double>(), 0.25,
                5 * std::sqrt(0.25 * 0.75 / n));
  }
}

TEST(InputNoise, WithoutItNothingIsDrawn) {
  TrainingBatch batch = batchOf(2, 6);
  auto random = generator(1), untouched = generator(1);
  disturbInputs(configOf(Json::object()), random, batch);
  EXPECT_FALSE(batch.seen.defined());
  EXPECT_FALSE(batch.own.defined());
  EXPECT_TRUE(torch::rand({4}, random).equal(torch::rand({4}, untouched)));
}

rnn::Config feedbackConfig(const std::string& cell = "lstm") {
  rnn::Config out;
  out.poseDim = kPoses;
  out.controlDim = kControls;
  out.past = 2;
  out.hidden = 16;
  out.cell = cell;
  out.feedback = true;
  return out;
}

/// Every family's history is what it is given, and its target what was recorded.
TEST(InputNoise, ReachesTheNetsOfEveryFamily) {
  moglow::Config flow;
  flow.poseDim = kPoses;
  flow.controlDim = kControls;
  flow.tau = 2;
  flow.steps = 1;
  flow.hidden = 8;
  flow.dropout = 0.0;
  vae::Config vae;
  vae.poseDim = kPoses;
  vae.controlDim = kControls;
  vae.hidden = 4;
  vae.layers = 1;
  const std::vector<std::shared_ptr<TrainableModel>> nets{
      std::make_shared<moglow::Net>(flow, moglow::BodyFacts{}, 1),
      std::make_shared<rnn::Net>(feedbackConfig(), 1), std::make_shared<vae::Net>(vae, 1)};
  for (const auto& net : nets) {
    // Last layers that start at zero would hide what a net sees.
    auto random = generator(7);
    const torch::NoGradGuard guard;
    for (auto& p : net->parameters()) p.add_(0.1 * torch::randn(p.sizes(), random));
    TrainingBatch batch = batchOf(3, 9);
    const double clean = net->loss(batch).sum.item<double>();
    batch.seen = batch.pose.clone();
    EXPECT_EQ(net->loss(batch).sum.item<double>(), clean);
    batch.seen = batch.pose + 1.0;
    EXPECT_NE(net->loss(batch).sum.item<double>(), clean) << net->objective().name;
  }
}

// ---- Scheduled sampling

TEST(ScheduledSampling, ItsShareGoesInAStraightLine) {
  const ScheduledSampling s{.from = 0.2, .to = 0.6, .beginStep = 10, .endStep = 30};
  for (const auto& [step, share] : {std::pair{0, 0.2}, {10, 0.2}, {15, 0.3}, {30, 0.6}, {99, 0.6}})
    EXPECT_NEAR(ownOutputShareAt(s, step), share, 1e-12) << step;
}

TEST(ScheduledSampling, TheShareOfFramesIsThatOfTheStep) {
  const auto config = configOf({{"scheduled_sampling", {{"to", 1.0}, {"end_step", 100}}}});
  TrainingBatch batch = batchOf(500, 40);
  for (const auto& [step, share] : {std::pair{0, 0.0}, {30, 0.3}, {100, 1.0}}) {
    batch.step = step;
    auto random = generator(1);
    disturbInputs(config, random, batch);
    EXPECT_NEAR(batch.own.mean().item<double>(), share,
                5 * std::sqrt(share * (1 - share) / 20000.0));
  }
}

TEST(ScheduledSampling, IsRefusedWhereANetSeesNoPoses) {
  rnn::Config blind = feedbackConfig();
  blind.feedback = false;
  const auto config = configOf({{"scheduled_sampling", {{"to", 1.0}, {"end_step", 100}}}});
  const auto message = test::messageOf<InputError>(
      [&] { requireSuitedInputs(config, rnn::Net(blind, 1), "c.json"); });
  EXPECT_NE(message.find("training.scheduled_sampling"), std::string::npos) << message;
  EXPECT_NO_THROW(requireSuitedInputs(config, rnn::Net(feedbackConfig(), 1), "c.json"));
}

/// The loss cell by cell: at each frame the pose before it, recorded or made.
double lossByHand(const rnn::Net& net, const TrainingBatch& batch) {
  const auto w = net.named_parameters();
  const auto& c = net.config();
  const Tensor &wi = w["weight_ih_l0"], &wh = w["weight_hh_l0"], &bi = w["bias_ih_l0"],
               &bh = w["bias_hh_l0"];
  Tensor h = torch::zeros({batch.pose.size(0), c.hidden}), cell = h.clone(), made;
  double sum = 0.0;
  for (int64_t t = c.past; t < batch.pose.size(1); ++t) {
    std::vector<Tensor> seen;
    for (int64_t k = t - c.past; k <= t; ++k) seen.push_back(batch.control.select(1, k));
    Tensor before = batch.pose.select(1, t - 1).clone();
    for (int64_t b = 0; b < before.size(0); ++b)
      if (made.defined() && batch.own[b][t - 1].item<float>() == 1.f) before[b] = made[b];
    seen.push_back(before);
    const Tensor x = torch::cat(seen, 1);
    if (c.cell == "lstm")
      std::tie(h, cell) = torch::lstm_cell(x, {h, cell}, wi, wh, bi, bh);
    else
      h = torch::gru_cell(x, h, wi, wh, bi, bh);
    made = h.matmul(w["out_weight"].t()) + w["out_bias"];
    sum += (made - batch.pose.select(1, t)).square().sum().item<double>();
  }
  return sum;
}

TEST(ScheduledSampling, GivesTheLossOfAWalkFrameByFrame) {
  for (const char* cell : {"lstm", "gru"}) {
    rnn::Net net(feedbackConfig(cell), 5);
    const torch::NoGradGuard guard;
    // So that what was made is as large as what was recorded.
    for (auto& p : net.parameters()) p.mul_(3.0);
    TrainingBatch batch = batchOf(4, 12);
    const double recorded = net.loss(batch).sum.item<double>();
    batch.own = torch::zeros({4, 12});
    // Sums of 40 squares of numbers near 1, in single precision.
    EXPECT_NEAR(net.loss(batch).sum.item<double>(), recorded, 1e-5 * recorded);
    EXPECT_NEAR(lossByHand(net, batch), recorded, 1e-5 * recorded);
    auto random = generator(6);
    batch.own = torch::rand({4, 12}, random).lt(0.5).to(torch::kFloat32);
    const double mixed = lossByHand(net, batch);
    EXPECT_NEAR(net.loss(batch).sum.item<double>(), mixed, 1e-5 * mixed);
    EXPECT_GT(std::abs(mixed - recorded), 1e-3 * recorded) << "nothing was fed back";
  }
}

/// Fed nothing but its own poses, a net is trained on the motion that the engine samples.
TEST(ScheduledSampling, InFullItTrainsOnWhatIsSampled) {
  const auto config = feedbackConfig();
  const auto net = std::make_shared<rnn::Net>(config, 5);
  TrainingBatch batch = batchOf(1, 14);
  batch.own = torch::ones({1, 14});
  ModelInfo info;
  info.poseDim = kPoses;
  info.controlDim = kControls;
  info.context = config.past;
  TensorFile file;
  storeWeights(*net, file);
  const rnn::EngineModel model(info, config, file, nn::Precision::Float32);
  const auto rows = [](const Tensor& t, int64_t first, int64_t count) {
    const auto part = t.narrow(0, first, count).contiguous();
    return Matrix(Eigen::Map<const Matrix>(part.data_ptr<float>(), 1, part.numel()));
  };
  const Tensor pose = batch.pose[0], control = batch.control[0];
  auto state = model.start(1, rows(pose, 0, config.past));
  double expected = 0.0;
  for (int64_t t = config.past; t < 14; ++t) {
    const Matrix made =
        model.sampleFrame(state, rows(control, t - config.past, config.past + 1), Matrix(1, 0));
    expected += (made - rows(pose, t, 1)).cast<double>().squaredNorm();
  }
  const torch::NoGradGuard guard;
  EXPECT_NEAR(net->loss(batch).sum.item<double>(), expected, 1e-5 * expected);
}

// ---- Whole runs

DataSet walkerData() {
  std::vector<Clip> clips;
  for (auto& walked : walkerDataSet(3, 4.0, 2, 20.0)) clips.push_back(std::move(walked.clip));
  Progress progress;
  DataSet out = prepareDataSet(clips, {}, {}, progress);
  out.hash = "walks";
  return out;
}

TEST(Trainer, ARunWithEveryOptionGoesOnToTheSameBits) {
  const DataSet data = walkerData();
  const std::vector<ModelFamily> families{rnn::family()};
  const test::TempFolder folder;
  const auto trained = [&](const char* run, int64_t steps, bool resume) {
    TrainRequest request;
    request.config = {{"family", "rnn"},
                      {"model", {{"hidden", 8}, {"past", 1}, {"feedback", true}}},
                      {"training",
                       {{"window_s", 1.0},
                        {"batch", 4},
                        {"optimiser", "rmsprop"},
                        {"rms_decay", 0.9},
                        {"learning_rate", 0.01},
                        {"schedule", "step"},
                        {"decay_every_steps", 2},
                        {"input_noise", 0.1},
                        {"input_dropout", 0.1},
                        {"scheduled_sampling", {{"to", 1.0}, {"end_step", 6}}},
                        {"steps", 6},
                        {"checkpoint_every", 3},
                        {"validation_share", 0.0}}}};
    request.configOrigin = "all.json";
    request.run = folder / run;
    request.steps = steps;
    request.resume = resume;
    Progress progress;
    return readTensorFile(train(data, request, families, progress).last);
  };
  const TensorFile whole = trained("whole", 6, false), half = trained("broken", 3, false),
                   resumed = trained("broken", 6, true);
  bool moved = false;
  for (const auto& [name, tensor] : whole.tensors) {
    EXPECT_EQ(tensor.bytes, resumed.tensors.at(name).bytes) << name;
    moved = moved || tensor.bytes != half.tensors.at(name).bytes;
  }
  EXPECT_TRUE(moved) << "no training";
}

}  // namespace
}  // namespace marey

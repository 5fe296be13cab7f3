// Steps of training: parts of a batch, clipping, optimisers and the schedules of their rates.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "../unit/base/support.h"
#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/json.h"
#include "model/gradient/adam.h"
#include "model/gradient/gradient_step.h"
#include "model/gradient/rms_prop.h"
#include "model/gradient/schedules.h"
#include "moglow/net.h"

namespace marey {
namespace {

using torch::Tensor;

moglow::Net tinyNet(Execution execution) {
  moglow::Config config;
  config.poseDim = 6;
  config.controlDim = 2;
  config.tau = 2;
  config.lookahead = 1;
  config.steps = 2;
  config.hidden = 32;
  config.dropout = 0.6;
  moglow::Net net(config, {}, 4);
  net.execution = execution;
  return net;
}

/// Seven windows, of which each has another number of real frames.
TrainingBatch unevenBatch(const TrainableModel& net) {
  auto random = at::detail::createCPUGenerator(8);
  TrainingBatch out{torch::randn({7, 12, 6}, random),
                    torch::randn({7, 12, 2}, random),
                    torch::zeros({7, 12}),
                    {}};
  for (int64_t b = 0; b < 7; ++b) out.mask[b].narrow(0, 0, 4 + b) = 1.f;
  out.draws = net.draw(out, random);
  return out;
}

struct Gradients {
  double loss = 0.0, norm = 0.0;
  std::vector<Tensor> values;
};

Gradients gradientsWith(int accumulate, Execution execution) {
  auto net = tinyNet(execution);
  TrainingConfig config;
  config.accumulate = accumulate;
  const auto group = nn::joinProcesses({}, {});
  GradientStep step(net, config, *group);
  const StepReport report = step.take(unevenBatch(net), 0.0, 1);
  EXPECT_TRUE(report.taken);
  Gradients out{report.loss, report.norm, {}};
  for (const auto& p : net.parameters()) out.values.push_back(p.grad().clone());
  return out;
}

void expectSame(const Gradients& found, const Gradients& expected) {
  EXPECT_NEAR(found.loss, expected.loss, 1e-5 * std::abs(expected.loss));
  EXPECT_NEAR(found.norm, expected.norm, 1e-5 * expected.norm);
  ASSERT_EQ(found.values.size(), expected.values.size());
  for (size_t i = 0; i < found.values.size(); ++i)
    EXPECT_LT((found.values[i] - expected.values[i]).abs().max().item<double>(),
              1e-5 * expected.values[i].abs().max().item<double>() + 1e-7)
        << i;
}

TEST(Optimiser, PartsOfABatchGiveTheGradientOfTheWhole) {
  const Gradients whole = gradientsWith(1, Execution::Engine);
  for (const int parts : {2, 3, 7}) expectSame(gradientsWith(parts, Execution::Engine), whole);
}

TEST(Optimiser, BothPathsHideAndLeaveOutTheSame) {
  expectSame(gradientsWith(1, Execution::Engine), gradientsWith(1, Execution::Reference));
}

TEST(Optimiser, AStepThatIsNotFiniteChangesNothing) {
  auto net = tinyNet(Execution::Engine);
  const auto group = nn::joinProcesses({}, {});
  TrainingConfig config;
  GradientStep step(net, config, *group);
  auto batch = unevenBatch(net);
  batch.pose[0][3][0] = std::nan("");
  std::vector<Tensor> before;
  for (const auto& p : net.parameters()) before.push_back(p.detach().clone());
  EXPECT_FALSE(step.take(batch, 0.1, 1).taken);
  const auto after = net.parameters();
  for (size_t i = 0; i < before.size(); ++i) EXPECT_TRUE(before[i].equal(after[i]));
}

/// Four steps of Adam with given gradients on 37 values.
Tensor adamOf(Execution execution, const GradientClip& clip) {
  auto random = at::detail::createCPUGenerator(2);
  struct OneTensor : torch::nn::Module {
    explicit OneTensor(const Tensor& start) { values = register_parameter("values", start); }
    Tensor values;
  } module(torch::randn({37}, random));
  Adam adam(module, execution);
  for (int64_t count = 1; count <= 4; ++count) {
    module.values.mutable_grad() = 10.0 * torch::randn({37}, random);
    adam.step(0.01, count, clip);
  }
  return module.values.detach();
}

TEST(Adam, OnePassGivesWhatTheChainOfOperationsGives) {
  for (const GradientClip& clip : {GradientClip{}, GradientClip{5.0, 0.3}}) {
    const Tensor fused = adamOf(Execution::Engine, clip),
                 plain = adamOf(Execution::Reference, clip);
    EXPECT_LT((fused - plain).abs().max().item<double>(), 2e-6);
  }
  EXPECT_GT((adamOf(Execution::Engine, {}) - adamOf(Execution::Engine, {0.5, 1.0}))
                .abs()
                .max()
                .item<double>(),
            1e-3);
}

TEST(Adam, ItsFirstStepIsTheRateAgainstTheGradientsSign) {
  struct OneTensor : torch::nn::Module {
    OneTensor() { values = register_parameter("values", torch::zeros({18})); }
    Tensor values;
  } module;
  module.values.mutable_grad() = torch::linspace(-9.f, 8.f, 18);
  Adam adam(module);
  adam.step(0.25, 1);
  const auto expected = -0.25 * torch::linspace(-9.f, 8.f, 18).sign();
  EXPECT_LT((module.values - expected).abs().max().item<double>(), 1e-6);
}

struct Values : torch::nn::Module {
  explicit Values(const std::vector<double>& start) {
    values = register_parameter("values", torch::tensor(start, torch::kFloat64));
  }
  Tensor values;
};

std::vector<double> doublesOf(const Tensor& t) {
  return {t.data_ptr<double>(), t.data_ptr<double>() + t.numel()};
}

/// Where an optimiser of ours leads in five steps of changing rate, in double precision.
std::vector<double> walkOf(const std::string& name) {
  Values module({1.0, -2.0, 0.5, 0.0});
  TrainingConfig config;
  config.optimiser = name;
  config.rmsDecay = 0.9;
  const auto optimiser = makeOptimiser(config, module, Execution::Engine);
  for (int64_t i = 1; i <= 5; ++i) {
    module.values.mutable_grad() = 2.0 * module.values.detach() + static_cast<double>(i);
    optimiser->step(0.1 / static_cast<double>(i), i);
  }
  return doublesOf(module.values.detach());
}

// The judge is PyTorch's own optimiser of that name.
TEST(Optimiser, AdamAndRmsPropWalkAsPyTorchsDo) {
  MAREY_NEED_PYTHON("torch");
  const test::TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), R"(
import json, torch
out = {}
for name, make in (("adam", lambda p: torch.optim.Adam([p])),
                   ("rmsprop", lambda p: torch.optim.RMSprop([p], alpha=0.9))):
    p = torch.tensor([1.0, -2.0, 0.5, 0.0], dtype=torch.float64, requires_grad=True)
    optimiser = make(p)
    for i in range(1, 6):
        for group in optimiser.param_groups: group["lr"] = 0.1 / i
        p.grad = 2.0 * p.detach() + i
        optimiser.step()
    out[name] = p.tolist()
json.dump(out, open("walk.json", "w"))
)"));
  const Json walks = readJson(folder / "walk.json");
  for (const char* name : {"adam", "rmsprop"}) {
    const auto expected = walks.at(name).get<std::vector<double>>(), found = walkOf(name);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 1e-12) << name << " " << i;
  }
}

TEST(Optimiser, RmsPropClipsWhatItUses) {
  Values module({1.0, 1.0});
  RmsProp optimiser(module, 0.75);
  module.values.mutable_grad() = torch::tensor({8.0, 0.5}, torch::kFloat64);
  optimiser.step(0.1, 1, {2.0, 0.5});
  // Clamped to 2 and halved: 1 and 0.25; each over the root of a quarter of its square, and 1e-8.
  EXPECT_NEAR(module.values[0].item<double>(), 1.0 - 0.1 * 1.0 / (0.5 + 1e-8), 1e-15);
  EXPECT_NEAR(module.values[1].item<double>(), 1.0 - 0.1 * 0.25 / (0.125 + 1e-8), 1e-15);
}

// ---- Schedules, by hand

TrainingConfig configOf(Json training) {
  return trainingConfigFromJson(training, "c.json");
}

TEST(Schedule, StepHalvesTheRateEverySoManySteps) {
  const auto c =
      configOf({{"schedule", "step"}, {"learning_rate", 0.8}, {"decay_every_steps", 10}});
  for (const auto& [step, rate] :
       {std::pair{0, 0.8}, {9, 0.8}, {10, 0.4}, {19, 0.4}, {20, 0.2}, {39, 0.1}})
    EXPECT_DOUBLE_EQ(learningRateAt(c, step, 7), rate) << step;
  EXPECT_DOUBLE_EQ(learningRateAt(c, 100000, 7), 1e-5) << "the minimum";
}

TEST(Schedule, StepByEpochsCountsWindowsSeen) {
  const auto c = configOf({{"schedule", "step"},
                           {"learning_rate", 1.0},
                           {"decay_every_epochs", 2},
                           {"decay_factor", 0.1},
                           {"batch", 4}});
  // Ten windows are an epoch; two of them are over with the fifth batch of four.
  for (const auto& [step, rate] : {std::pair{0, 1.0}, {4, 1.0}, {5, 0.1}, {9, 0.1}, {10, 0.01}})
    EXPECT_NEAR(learningRateAt(c, step, 10), rate, 1e-15) << step;
}

TEST(Schedule, LinearAndCosineRiseAndFallToTheMinimum) {
  for (const char* name : {"linear", "cosine"}) {
    const auto c = configOf({{"schedule", name},
                             {"learning_rate", 1.0},
                             {"minimum_rate", 0.5},
                             {"warmup_steps", 10},
                             {"steps", 110}});
    EXPECT_DOUBLE_EQ(learningRateAt(c, 4, 1), 0.5) << name;  // the fifth step of ten
    EXPECT_DOUBLE_EQ(learningRateAt(c, 9, 1), 1.0) << name;
    EXPECT_NEAR(learningRateAt(c, 59, 1), 0.75, 1e-12) << name;  // half-way down
    EXPECT_NEAR(learningRateAt(c, 109, 1), 0.5, 1e-12) << name;
    EXPECT_NEAR(learningRateAt(c, 1000, 1), 0.5, 1e-12) << name;
  }
  const auto linear = configOf({{"schedule", "linear"},
                                {"learning_rate", 1.0},
                                {"minimum_rate", 0.0},
                                {"warmup_steps", 1},
                                {"steps", 101}});
  EXPECT_NEAR(learningRateAt(linear, 25, 1), 0.75, 1e-12);
}

TEST(TrainingConfig, RefusesKeysThatHaveNoEffect) {
  const auto refused = [](Json training, const char* key) {
    const auto message = test::messageOf<InputError>([&] { configOf(training); });
    EXPECT_NE(message.find(key), std::string::npos) << message;
    EXPECT_NE(message.find("c.json"), std::string::npos) << message;
  };
  refused({{"rms_decay", 0.9}}, "rms_decay");
  refused({{"decay_every_steps", 10}}, "decay_every_steps");
  refused({{"schedule", "cosine"}, {"decay_factor", 0.1}}, "decay_factor");
  refused({{"schedule", "step"}}, "decay_every_epochs");
  refused({{"schedule", "step"}, {"decay_every_steps", 1}, {"decay_every_epochs", 1}}, "both");
  refused({{"schedule", "stairs"}}, "step");
  refused({{"optimiser", "sgd"}}, "rmsprop");
  refused({{"input_dropout", 1.0}}, "input_dropout");
  refused({{"input_noise", -0.1}}, "input_noise");
  refused({{"leraning_rate", 0.1}}, "leraning_rate");
  refused({{"scheduled_sampling", {{"to", 1.5}, {"end_step", 10}}}}, "scheduled_sampling.to");
  refused({{"scheduled_sampling", {{"to", 1.0}, {"end_step", 0}}}}, "end_step");
  refused({{"scheduled_sampling", {{"too", 1.0}, {"end_step", 9}}}}, "to");
}

TEST(TrainingConfig, IsWhatItWasAfterBeingWritten) {
  const Json given = {
      {"optimiser", "rmsprop"},
      {"rms_decay", 0.95},
      {"schedule", "step"},
      {"decay_every_epochs", 3},
      {"input_noise", 0.1},
      {"input_dropout", 0.2},
      {"scheduled_sampling", {{"from", 0.1}, {"to", 0.5}, {"begin_step", 5}, {"end_step", 50}}}};
  const TrainingConfig config = configOf(given);
  EXPECT_EQ(toJson(configOf(toJson(config))), toJson(config));
  for (const auto& [key, value] : given.items()) EXPECT_EQ(toJson(config).at(key), value) << key;
  EXPECT_EQ(toJson(configOf(toJson(TrainingConfig{}))), toJson(TrainingConfig{}));
}

TEST(TrainingConfig, ABatchHasNoMorePartsThanWindows) {
  EXPECT_EQ(trainingConfigFromJson({{"batch", 8}, {"accumulate", 8}}, "c.json").accumulate, 8);
  for (const int parts : {0, 9})
    EXPECT_THROW(trainingConfigFromJson({{"batch", 8}, {"accumulate", parts}}, "c.json"),
                 InputError);
}

TEST(MeetingPoint, IsWhatTheEnvironmentSaysOrMadeFromTheRun) {
  unsetenv("MASTER_ADDR");
  unsetenv("MASTER_PORT");
  const nn::MeetingPoint made = nn::meetingPoint("runs/a");
  EXPECT_EQ(made.host, "127.0.0.1");
  EXPECT_EQ(nn::meetingPoint("runs/a").port, made.port);
  EXPECT_NE(nn::meetingPoint("runs/b").port, made.port);
  setenv("MASTER_ADDR", "node7", 1);
  setenv("MASTER_PORT", "4321", 1);
  EXPECT_EQ(nn::meetingPoint("runs/a").host, "node7");
  EXPECT_EQ(nn::meetingPoint("runs/a").port, 4321);
  for (const char* bad : {"0", "70000", "12a", ""}) {
    setenv("MASTER_PORT", bad, 1);
    EXPECT_THROW(nn::meetingPoint("runs/a"), InputError) << bad;
  }
  unsetenv("MASTER_ADDR");
  unsetenv("MASTER_PORT");
}

}  // namespace
}  // namespace marey

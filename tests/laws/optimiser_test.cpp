// Steps of training: parts of a batch, clipping, Adam.
#include "model/optimiser.h"

#include <cmath>
#include <cstdlib>

#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "base/error.h"
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
  Optimiser optimiser(net, config, *group);
  const StepReport report = optimiser.step(unevenBatch(net), 0.0, 1);
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
  Optimiser optimiser(net, config, *group);
  auto batch = unevenBatch(net);
  batch.pose[0][3][0] = std::nan("");
  std::vector<Tensor> before;
  for (const auto& p : net.parameters()) before.push_back(p.detach().clone());
  EXPECT_FALSE(optimiser.step(batch, 0.1, 1).taken);
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
}

}  // namespace
}  // namespace marey

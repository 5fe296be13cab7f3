// The fast path of training against the plain libtorch path.
#include <algorithm>
#include <cmath>
#include <string>

#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "model/gradient/weights.h"
#include "moglow/family.h"
#include "moglow/net.h"
#include "nn/flow/fast_flow.h"

namespace marey {
namespace {

using torch::Tensor;

at::Generator generator(uint64_t seed) {
  return at::detail::createCPUGenerator(seed);
}

/// Weights that start at zero are drawn too, so that no gradient vanishes.
void makeLively(torch::nn::Module& module, uint64_t seed) {
  const torch::NoGradGuard guard;
  auto random = generator(seed);
  for (auto& item : module.named_parameters())
    if (item.key().find("weight_") == std::string::npos)
      item.value().add_(0.1 * torch::randn(item.value().sizes(), random));
}

std::vector<Tensor> gradientsOf(const torch::nn::Module& module) {
  std::vector<Tensor> out;
  for (const auto& p : module.parameters()) {
    out.push_back(p.grad().to(torch::kFloat64).clone());
    p.mutable_grad() = Tensor();
  }
  return out;
}

/// Of the largest value of `exact`.
double relativeError(const Tensor& found, const Tensor& exact) {
  return (found.to(torch::kFloat64) - exact).abs().max().item<double>() /
         (exact.abs().max().item<double>() + 1e-12);
}

struct Shape {
  std::string cell;
  int64_t hidden, layers, steps, channels, conditioning, batch, frames;
  double keep;  ///< share of the blocks that are there; 1: no blocks
};

/// Loss and gradients of both paths, the plain one in float64.
class Paths {
 public:
  explicit Paths(const Shape& s)
      : m_random(generator(3)),
        m_flow({.channels = s.channels,
                .conditioning = s.conditioning,
                .steps = s.steps,
                .net = {.cell = s.cell, .hidden = s.hidden, .layers = s.layers}},
               m_random) {
    makeLively(m_flow, 5);
    m_x = torch::randn({s.batch, s.frames, s.channels}, m_random);
    m_seen = {torch::randn({s.batch, s.frames, s.conditioning}, m_random), {}, 3};
    if (s.keep < 1.0) {
      m_seen.keep = torch::rand({s.batch, s.frames, 2}, m_random).lt(s.keep).to(torch::kFloat32);
      auto blocks = m_seen.values.narrow(-1, 0, 6).unflatten(-1, at::IntArrayRef{2, 3});
      blocks.mul_(m_seen.keep.unsqueeze(-1));
    }
    // Every latent and log-determinant counts, each with a weight of its own.
    m_weightOfZ = torch::randn(m_x.sizes(), m_random);
    m_weightOfLogDet = torch::randn({s.batch, s.frames}, m_random);
  }

  void compare(double tolerance) {
    ASSERT_TRUE(nn::takesFastPath(m_flow, m_x, m_seen));
    const auto fast = nn::fastToLatent(m_flow, m_x, m_seen);
    loss(fast).backward();
    const auto found = gradientsOf(m_flow);
    m_flow.to(torch::kFloat64);
    nn::FlowState state;
    const auto exact =
        m_flow.toLatent(m_x.to(torch::kFloat64), m_seen.values.to(torch::kFloat64), state);
    loss(exact).backward();
    const auto expected = gradientsOf(m_flow);
    EXPECT_LT(relativeError(fast.value, exact.value), tolerance);
    EXPECT_LT(relativeError(fast.logDet, exact.logDet), tolerance);
    const auto names = m_flow.named_parameters().keys();
    for (size_t i = 0; i < names.size(); ++i) {
      // One frame has nothing to remember.
      if (m_x.size(1) > 1) {
        EXPECT_GT(expected[i].abs().max().item<double>(), 0.0) << names[i];
      }
      EXPECT_LT(relativeError(found[i], expected[i]), tolerance) << names[i];
    }
  }

 private:
  Tensor loss(const nn::Transformed& t) const {
    return (t.value.square() * m_weightOfZ.to(t.value.options())).sum() +
           (t.logDet * m_weightOfLogDet.to(t.value.options())).sum();
  }

  at::Generator m_random;
  nn::Flow m_flow;
  Tensor m_x, m_weightOfZ, m_weightOfLogDet;
  nn::FlowConditioning m_seen;
};

class FastTraining : public testing::TestWithParam<Shape> {};

TEST_P(FastTraining, GivesTheLatentAndEveryGradientOfThePlainPathInFloat64) {
  Paths(GetParam()).compare(2e-5);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FastTraining,
                         testing::Values(Shape{"lstm", 32, 2, 3, 7, 11, 5, 9, 1.0},
                                         Shape{"lstm", 64, 1, 1, 2, 6, 1, 1, 1.0},
                                         Shape{"lstm", 32, 3, 2, 40, 9, 13, 4, 0.3},
                                         Shape{"gru", 32, 2, 3, 7, 11, 5, 9, 1.0},
                                         Shape{"gru", 96, 1, 2, 33, 8, 3, 6, 0.2},
                                         Shape{"gru", 32, 1, 1, 4, 6, 2, 1, 0.0},
                                         Shape{"feedforward", 24, 2, 3, 7, 11, 5, 9, 1.0},
                                         Shape{"feedforward", 8, 1, 2, 6, 7, 4, 3, 0.4}),
                         [](const auto& info) {
                           return info.param.cell + std::to_string(info.index);
                         });

TEST(FastTrainingPath, TakesOnlyWhatItCanDo) {
  auto random = generator(1);
  const auto flowOf = [&](int64_t hidden, const char* cell) {
    return nn::Flow({.channels = 4, .conditioning = 3, .steps = 1, .net = {cell, hidden, 1}},
                    random);
  };
  const auto x = torch::zeros({2, 3, 4}), c = torch::zeros({2, 3, 3});
  EXPECT_TRUE(nn::takesFastPath(flowOf(64, "gru"), x, {c}));
  EXPECT_FALSE(nn::takesFastPath(flowOf(48, "lstm"), x, {c}));
  EXPECT_FALSE(nn::takesFastPath(flowOf(64, "lstm"), x.to(torch::kFloat64), {c}));
  EXPECT_FALSE(nn::takesFastPath(flowOf(64, "lstm"), x, {c.clone().requires_grad_(true)}));
}

TEST(FastTrainingPath, ASecondGradientIsRefused) {
  auto random = generator(1);
  const nn::Flow flow(
      {.channels = 4, .conditioning = 3, .steps = 2, .net = {.cell = "lstm", .hidden = 32}},
      random);
  const auto loss =
      nn::fastToLatent(flow, torch::ones({2, 3, 4}), {torch::ones({2, 3, 3})}).value.sum();
  loss.backward({}, /*retain_graph=*/true);
  EXPECT_THROW(loss.backward(), c10::Error);
}

/// Log-likelihoods and gradients of a model in training on a few windows of noise.
struct NetRun {
  NetRun(moglow::Net& net, int64_t poseDim, Execution execution, torch::Dtype type) {
    auto random = generator(6);
    const int64_t window = net.context() + 6 + net.lookahead();
    TrainingBatch batch{(0.3 * torch::randn({3, window, poseDim}, random)).to(type),
                        (0.3 * torch::randn({3, window, 3}, random)).to(type),
                        torch::ones({3, window}, type),
                        {}};
    batch.draws = net.draw(batch, random);
    net.execution = execution;
    net.train();
    net.to(type);
    values = net.logLikelihood(batch).to(torch::kFloat64);
    values.mean().backward();
    gradients = gradientsOf(net);
  }
  /// The largest relative error of a gradient.
  double errorAgainst(const NetRun& exact) const {
    double out = relativeError(values, exact.values);
    for (size_t i = 0; i < gradients.size(); ++i)
      out = std::max(out, relativeError(gradients[i], exact.gradients[i]));
    return out;
  }
  Tensor values;
  std::vector<Tensor> gradients;
};

TEST(FastTrainingPath, HidesTheHistoryThatALinearBaseShows) {
  moglow::Config config;
  config.poseDim = 12;
  config.tau = 4;
  config.lookahead = 2;
  config.steps = 2;
  config.hidden = 32;
  config.dropout = 0.7;
  config.poseBase = "linear";
  moglow::Net net(config, {}, 2);
  makeLively(net, 9);
  for (auto& item : net.named_buffers())
    if (item.key() == "base.weight") item.value().normal_(0.0, 0.05, generator(4));
  const NetRun fast(net, 12, Execution::Engine, torch::kFloat32),
      exact(net, 12, Execution::Reference, torch::kFloat64);
  EXPECT_LT(fast.errorAgainst(exact), 2e-5);
}

TEST(FastTrainingPath, TrainsOnTheInnovationsOfAKinematicBase) {
  const std::string path = MAREY_SOURCE_DIR "/resources/models/moglow-plus-small.marey";
  const TensorFile file = readTensorFile(path);
  const ModelInfo info = loadCommon(file, path);
  const Trainee trainee = moglow::family().makeTrainee(
      info.config, path, {info.poseDim, info.controlDim, info.skeleton, info.standardiser}, 1);
  auto& net = dynamic_cast<moglow::Net&>(*trainee.net);
  loadWeights(net, file, path);
  const NetRun fast(net, info.poseDim, Execution::Engine, torch::kFloat32),
      plain(net, info.poseDim, Execution::Reference, torch::kFloat32);
  // Not float64: a base chooses regimes by thresholds. Noise is far from what it has learned, and
  // large innovations round coarsely.
  EXPECT_GT(fast.errorAgainst(plain), 0.0);
  EXPECT_LT(fast.errorAgainst(plain), 5e-4);
}

}  // namespace
}  // namespace marey

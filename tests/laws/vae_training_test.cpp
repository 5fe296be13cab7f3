// The autoencoder in training: what its loss is, that padding is of no effect, and its gradients.
#include <cmath>
#include <filesystem>
#include <numbers>

#include "vae/net.h"
#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "model/gradient/gradient_step.h"
#include "nn/torch/threads.h"

namespace marey::vae {
namespace {

using torch::Tensor;

Config tinyConfig(const std::string& decoder) {
  Config out;
  out.poseDim = 3;
  out.controlDim = 2;
  out.hidden = 3;
  out.layers = 2;
  out.latent = 2;
  out.decoder = decoder;
  out.kldWeight = 0.5;
  out.kldWarmupSteps = 10;
  return out;
}

/// Windows of which each has another number of real frames, in double precision.
TrainingBatch unevenBatch(const Config& config, int64_t windows = 4, int64_t frames = 7) {
  auto random = at::detail::createCPUGenerator(8);
  const auto draw = [&](std::vector<int64_t> shape) {
    return torch::randn(shape, random, torch::kFloat64);
  };
  TrainingBatch out{.pose = draw({windows, frames, config.poseDim}),
                    .control = draw({windows, frames, config.controlDim}),
                    .mask = torch::zeros({windows, frames}, torch::kFloat64)};
  for (int64_t b = 0; b < windows; ++b) out.mask[b].narrow(0, 0, frames - b) = 1.0;
  out.draws = draw({windows, config.latent});
  out.step = 5;
  return out;
}

std::shared_ptr<Net> netOf(const Config& config) {
  auto out = std::make_shared<Net>(config, 4);
  out->to(torch::kFloat64);
  return out;
}

double largest(const Tensor& t) {
  return t.abs().max().item<double>();
}

TEST(VaeConfig, TheOneOfThePaperHasFourMillionParameters) {
  const Config paper = configFromJson(
      readJson(std::filesystem::path(MAREY_SOURCE_DIR) / "resources/models/vae-human.json"),
      "vae-human.json");
  EXPECT_EQ(paper.hidden, 256);
  EXPECT_EQ(paper.layers, 2);
  EXPECT_EQ(paper.latent, 2);
  EXPECT_EQ(paper.decoder, "deterministic");
  EXPECT_NEAR(static_cast<double>(parametersOf(paper)) / 1e6, 4.0, 0.5);
}

TEST(VaeConfig, CountsTheParametersThatANetworkHas) {
  for (const char* decoder : {"deterministic", "gaussian"})
    for (const int layers : {1, 3}) {
      Config config = tinyConfig(decoder);
      config.layers = layers;
      const Net net(config, 1);
      int64_t count = 0;
      for (const auto& p : net.parameters()) count += p.numel();
      EXPECT_EQ(parametersOf(config), count);
    }
}

TEST(VaeConfig, IsReadStrictlyAndBack) {
  Config config = tinyConfig("gaussian");
  EXPECT_EQ(toJson(configFromJson(toJson(config), "c.json")), toJson(config));
  const auto refusal = [](const Json& json) -> std::string {
    try {
      configFromJson(json, "c.json");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, Json>>{{"hiden", 3},
                                                 {"hidden", 0},
                                                 {"layers", 0},
                                                 {"latent", 0},
                                                 {"latent", 2.5},
                                                 {"decoder", "student"},
                                                 {"kld_weight", -1},
                                                 {"pose_dim", 0},
                                                 {"control_dim", 0},
                                                 {"kld_warmup_steps", -1}}) {
    const std::string why = refusal({{key, value}});
    EXPECT_NE(why.find("c.json"), std::string::npos) << key;
    EXPECT_NE(why.find(key), std::string::npos) << why;
  }
}

/// PyTorch's own bidirectional LSTM.
TEST(VaeNet, GoesBothWaysAsPyTorchDoes) {
  auto random = at::detail::createCPUGenerator(2);
  BidirectionalLstm lstm(5, 4, 2, random);
  lstm.to(torch::kFloat64);
  const auto x = torch::randn({3, 9, 5}, random, torch::kFloat64);
  const auto zeros = torch::zeros({4, 3, 4}, torch::kFloat64);
  const auto wanted = std::get<0>(
      torch::lstm(x, {zeros, zeros}, lstm.parameters(), true, 2, 0.0, false, true, true));
  const auto got = lstm.forward(x, reversedFrames(torch::ones({3, 9})));
  EXPECT_EQ(got.sizes(), wanted.sizes());
  EXPECT_LT(largest(got - wanted), 1e-12);
}

TEST(VaeNet, PaddingIsOfNoEffect) {
  for (const char* decoder : {"deterministic", "gaussian"}) {
    const Config config = tinyConfig(decoder);
    const auto net = netOf(config);
    const TrainingBatch batch = unevenBatch(config);
    TrainingBatch other = batch;
    const auto real = batch.mask.unsqueeze(2);
    other.pose = batch.pose * real + 100.0 * (1.0 - real);
    other.control = batch.control * real - 30.0 * (1.0 - real);
    const Posterior a = net->encode(batch.pose, batch.control, batch.mask),
                    b = net->encode(other.pose, other.control, other.mask);
    EXPECT_TRUE(a.mean.equal(b.mean));
    EXPECT_TRUE(a.logVariance.equal(b.logVariance));
    EXPECT_TRUE(net->loss(batch).sum.equal(net->loss(other).sum));
    // And each window is what it is without its padding.
    double sum = 0.0;
    for (int64_t i = 0; i < 4; ++i) {
      TrainingBatch one = batch.narrow(i, 1);
      const int64_t length = 7 - i;
      one.pose = one.pose.narrow(1, 0, length);
      one.control = one.control.narrow(1, 0, length);
      one.mask = one.mask.narrow(1, 0, length);
      const Posterior alone = net->encode(one.pose, one.control, one.mask);
      EXPECT_LT(largest(alone.mean[0] - a.mean[i]), 1e-12);
      sum += net->loss(one).sum.item<double>();
    }
    EXPECT_NEAR(sum, net->loss(batch).sum.item<double>(), 1e-11 * std::abs(sum));
  }
}

/// A mean over frames does not tell how often they were repeated: without recurrent weights and
/// with constant frames, clips of any length have one posterior.
TEST(VaeNet, PoolsByTheMeanOverRealFrames) {
  const torch::NoGradGuard guard;
  const Config config = tinyConfig("deterministic");
  const auto net = netOf(config);
  // Forget and recurrence gates off: what comes out of a frame is of that frame alone.
  for (auto& item : net->named_parameters())
    if (item.key().starts_with("encoder.")) {
      if (item.key().find("weight_hh") != std::string::npos) item.value().zero_();
      if (item.key().find("bias_ih") != std::string::npos) item.value().narrow(0, 3, 3) = -1e3;
    }
  const TrainingBatch batch = unevenBatch(config);
  const auto frames = [&](int64_t first, int64_t count) {
    return net
        ->encode(batch.pose.narrow(0, 0, 1).narrow(1, first, count),
                 batch.control.narrow(0, 0, 1).narrow(1, first, count),
                 torch::ones({1, count}, torch::kFloat64))
        .mean;
  };
  Tensor mean = torch::zeros({1, 2}, torch::kFloat64);
  for (int64_t t = 0; t < 5; ++t) mean += frames(t, 1) / 5.0;
  EXPECT_LT(largest(frames(0, 5) - mean), 1e-12);
}

TEST(VaeNet, DivergenceIsWhatDrawsOfThePosteriorSay) {
  auto random = at::detail::createCPUGenerator(3);
  const Posterior p{.mean = torch::tensor({{0.7, -1.2}}, torch::kFloat64),
                    .logVariance = torch::tensor({{-0.9, 0.4}}, torch::kFloat64)};
  constexpr int64_t kDraws = 400000;
  const auto e = torch::randn({kDraws, 2}, random, torch::kFloat64);
  const auto z = p.mean + (0.5 * p.logVariance).exp() * e;
  // log q(z) - log p(z)
  const auto logs = (-0.5 * e.square() - 0.5 * p.logVariance + 0.5 * z.square()).sum(1);
  const double error = logs.std().item<double>() / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(divergence(p)[0].item<double>(), logs.mean().item<double>(), 5.0 * error);
  EXPECT_LT(error, 0.005);
  const Posterior prior{torch::zeros({1, 2}), torch::zeros({1, 2})};
  EXPECT_EQ(divergence(prior)[0].item<double>(), 0.0);
}

double normalLog(double x, double mean, double logVariance) {
  return -0.5 * (std::log(2.0 * std::numbers::pi) + logVariance +
                 (x - mean) * (x - mean) / std::exp(logVariance));
}

/// Value by value, from the network's own posterior and poses.
TEST(VaeNet, LossIsReconstructionAndDivergence) {
  const torch::NoGradGuard guard;
  for (const char* decoder : {"deterministic", "gaussian"}) {
    const Config config = tinyConfig(decoder);
    const auto net = netOf(config);
    const bool gaussian = config.gaussian();
    if (gaussian) net->named_parameters()["log_variance"].copy_(torch::tensor({-1.0, 0.5, 0.2}));
    const TrainingBatch batch = unevenBatch(config);
    const Posterior p = net->encode(batch.pose, batch.control, batch.mask);
    const auto made =
        net->decode(p.mean + (0.5 * p.logVariance).exp() * batch.draws, batch.control, batch.mask);
    double error = 0.0;
    for (int64_t b = 0; b < 4; ++b)
      for (int64_t t = 0; t < 7 - b; ++t)
        for (int64_t d = 0; d < 3; ++d) {
          const double x = batch.pose[b][t][d].item<double>(), m = made[b][t][d].item<double>();
          const double logVariance[] = {-1.0, 0.5, 0.2};
          error += gaussian ? -normalLog(x, m, logVariance[d]) : (x - m) * (x - m) / 3.0;
        }
    const double kld = divergence(p).sum().item<double>();
    const Loss loss = net->loss(batch);
    ASSERT_EQ(loss.terms.size(), net->objective().terms.size());
    EXPECT_EQ(loss.terms[0].first, net->objective().terms[0]);
    EXPECT_EQ(loss.terms[1].first, net->objective().terms[1]);
    EXPECT_NEAR(loss.terms[0].second.item<double>(), error, 1e-6 * std::abs(error));
    // Half of the warm-up has passed: half of the weight.
    EXPECT_NEAR(loss.terms[1].second.item<double>(), 0.25 * kld, 1e-12 * kld);
    EXPECT_NEAR(loss.sum.item<double>(), error + 0.25 * kld, 1e-6 * std::abs(error));
    EXPECT_EQ(net->weight(batch), 7 + 6 + 5 + 4);
  }
}

TEST(VaeNet, TheDivergenceWarmsUpInTrainingAndIsWholeInEvaluation) {
  const Config config = tinyConfig("deterministic");
  const auto net = netOf(config);
  TrainingBatch batch = unevenBatch(config);
  const double kld =
      divergence(net->encode(batch.pose, batch.control, batch.mask)).sum().item<double>();
  const auto share = [&](int64_t step) {
    batch.step = step;
    return net->loss(batch).terms[1].second.item<double>() / kld;
  };
  EXPECT_EQ(share(0), 0.0);
  EXPECT_NEAR(share(1), 0.05, 1e-12);
  EXPECT_NEAR(share(10), 0.5, 1e-12);
  EXPECT_NEAR(share(1000), 0.5, 1e-12);
  batch.draws = torch::Tensor();
  EXPECT_NEAR(share(0), 0.5, 1e-12);
  EXPECT_EQ(net->loss(batch).sum.item<double>(), net->loss(batch).sum.item<double>());
}

TEST(VaeNet, ItsGradientsAreDifferencesOfItsLoss) {
  nn::configureThreads(1, true);  // thousands of tiny products
  for (const char* decoder : {"deterministic", "gaussian"}) {
    const Config config = tinyConfig(decoder);
    const auto net = netOf(config);
    const TrainingBatch batch = unevenBatch(config, 2, 4);
    net->loss(batch).sum.backward();
    const torch::NoGradGuard guard;
    double largestGradient = 0.0;
    for (const auto& item : net->named_parameters()) {
      const auto gradient = item.value().grad().flatten();
      auto values = item.value().flatten();  // a view
      ASSERT_EQ(values.data_ptr(), item.value().data_ptr());
      for (int64_t i = 0; i < values.numel(); ++i) {
        const double value = values[i].item<double>(), step = 1e-5;
        const auto at = [&](double x) {
          values[i] = x;
          return net->loss(batch).sum.item<double>();
        };
        const double difference = (at(value + step) - at(value - step)) / (2.0 * step);
        values[i] = value;
        const double exact = gradient[i].item<double>();
        // Differences err by step^2 of the third derivative, and by the loss's rounding over step.
        EXPECT_NEAR(exact, difference, 1e-7 * (1.0 + std::abs(exact))) << item.key() << " " << i;
        largestGradient = std::max(largestGradient, std::abs(exact));
      }
    }
    EXPECT_GT(largestGradient, 0.1) << "nothing was compared";
  }
  nn::configureThreads(0, true);
}

TEST(VaeNet, TwentyStepsLowerTheLoss) {
  nn::configureThreads(1, true);
  for (const char* decoder : {"deterministic", "gaussian"}) {
    Config config = tinyConfig(decoder);
    config.hidden = 16;
    config.kldWarmupSteps = 0;
    Net net(config, 1);
    TrainingBatch batch = unevenBatch(config, 6, 12);
    for (Tensor* t : {&batch.pose, &batch.control, &batch.mask, &batch.draws})
      *t = t->to(torch::kFloat32);
    TrainingConfig training;
    const auto group = nn::joinProcesses({}, {});
    GradientStep gradient(net, training, *group);
    std::vector<double> losses;
    for (int64_t step = 0; step < 20; ++step) {
      const StepReport report = gradient.take(batch, 0.01, step + 1);
      ASSERT_TRUE(report.taken);
      ASSERT_EQ(report.terms.size(), 2U);
      EXPECT_NEAR(report.terms[0] + report.terms[1], report.loss, 1e-5 * std::abs(report.loss));
      losses.push_back(report.loss);
    }
    EXPECT_LT(losses.back(), 0.95 * losses.front()) << decoder;
  }
  nn::configureThreads(0, true);
}

TEST(VaeNet, DrawsAreOfTheGeneratorAlone) {
  const Config config = tinyConfig("deterministic");
  const auto net = netOf(config);
  const TrainingBatch batch = unevenBatch(config);
  const auto drawn = [&](uint64_t seed) {
    auto generator = at::detail::createCPUGenerator(seed);
    return net->draw(batch, generator);
  };
  EXPECT_EQ(drawn(1).sizes(), (std::vector<int64_t>{4, 2}));
  EXPECT_TRUE(drawn(1).equal(drawn(1)));
  EXPECT_FALSE(drawn(1).equal(drawn(2)));
}

}  // namespace
}  // namespace marey::vae

#include "vae/net.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <ATen/CPUGeneratorImpl.h>

namespace marey::vae {
namespace {

/// PyTorch's start of recurrent and linear layers: uniform in +-1/sqrt(inputs).
torch::Tensor uniformStart(std::vector<int64_t> shape, int64_t inputs, at::Generator& generator) {
  const double bound = 1.0 / std::sqrt(static_cast<double>(inputs));
  return torch::rand(shape, generator) * (2.0 * bound) - bound;
}

torch::Tensor runLstm(const torch::Tensor& input, const std::vector<torch::Tensor>& weights,
                      int64_t hidden, bool training) {
  const auto zeros = torch::zeros({1, input.size(0), hidden}, input.options());
  return std::get<0>(
      torch::lstm(input, {zeros, zeros}, weights, true, 1, 0.0, training, false, true));
}

torch::Tensor gatherFrames(const torch::Tensor& frames, const torch::Tensor& order) {
  return frames.gather(1, order.expand({-1, -1, frames.size(2)}));
}

}  // namespace

BidirectionalLstm::BidirectionalLstm(int64_t inputs, int64_t hidden, int64_t layers,
                                     at::Generator& generator)
    : m_hidden(hidden) {
  for (int64_t i = 0; i < layers; ++i) {
    const int64_t seen = i == 0 ? inputs : 2 * hidden;
    const auto way = [&](const std::string& name) {
      const std::string start = "layer" + std::to_string(i) + "_" + name + "_";
      std::vector<torch::Tensor> out;
      const auto add = [&](const char* what, std::vector<int64_t> shape) {
        out.push_back(
            register_parameter(start + what, uniformStart(std::move(shape), hidden, generator)));
      };
      add("weight_ih", {4 * hidden, seen});
      add("weight_hh", {4 * hidden, hidden});
      add("bias_ih", {4 * hidden});
      add("bias_hh", {4 * hidden});
      return out;
    };
    auto ahead = way("ahead"), back = way("back");
    m_layers.push_back({std::move(ahead), std::move(back)});
  }
}

torch::Tensor BidirectionalLstm::forward(const torch::Tensor& input,
                                         const torch::Tensor& reversed) const {
  torch::Tensor x = input;
  for (const Layer& layer : m_layers) {
    const auto back = runLstm(gatherFrames(x, reversed), layer.back, m_hidden, is_training());
    x = torch::cat({runLstm(x, layer.ahead, m_hidden, is_training()), gatherFrames(back, reversed)},
                   2);
  }
  return x;
}

torch::Tensor reversedFrames(const torch::Tensor& mask) {
  const auto lengths = mask.sum(1, true).to(torch::kInt64);
  const auto frames = torch::arange(mask.size(1), lengths.options()).expand(mask.sizes());
  return torch::where(frames < lengths, lengths - 1 - frames, frames).unsqueeze(2);
}

torch::Tensor divergence(const Posterior& p) {
  return 0.5 * (p.mean.square() + p.logVariance.exp() - 1.0 - p.logVariance).sum(1);
}

Net::Net(const Config& config, uint64_t seed) : m_config(config) {
  auto generator = at::detail::createCPUGenerator(seed);
  const int64_t h = config.hidden, d = config.poseDim, c = config.controlDim, z = config.latent;
  m_encoder = register_module(
      "encoder", std::make_shared<BidirectionalLstm>(c + d, h, config.layers, generator));
  m_decoder = register_module(
      "decoder", std::make_shared<BidirectionalLstm>(c + z, h, config.layers, generator));
  const auto add = [&](const char* name, std::vector<int64_t> shape) {
    return register_parameter(name, uniformStart(std::move(shape), 2 * h, generator));
  };
  m_latentWeight = add("latent_weight", {2 * z, 2 * h});
  m_latentBias = add("latent_bias", {2 * z});
  m_poseWeight = add("pose_weight", {d, 2 * h});
  m_poseBias = add("pose_bias", {d});
  if (config.gaussian()) m_logVariance = register_parameter("log_variance", torch::zeros({d}));
}

Objective Net::objective() const {
  // Neither is a likelihood: the latent is no draw of the prior, and of one place only.
  Objective out{.name = "mean squared error and divergence",
                .unit = "squared standard deviations per frame",
                .likelihood = false,
                .terms = {"reconstruction", "kld"}};
  if (!m_config.gaussian()) return out;
  out.name = "reconstruction's log-loss and divergence";
  out.unit = "nats per frame";
  return out;
}

torch::Tensor Net::draw(const TrainingBatch& batch, at::Generator& generator) const {
  // Drawn on the CPU, so that a device changes no batch.
  return torch::randn({batch.pose.size(0), m_config.latent}, generator).to(batch.pose.options());
}

Posterior Net::encode(const torch::Tensor& pose, const torch::Tensor& control,
                      const torch::Tensor& mask) const {
  const auto frames = m_encoder->forward(torch::cat({control, pose}, 2), reversedFrames(mask));
  const auto real = mask.unsqueeze(2);
  const auto pooled = (frames * real).sum(1) / real.sum(1);
  const auto out = torch::nn::functional::linear(pooled, m_latentWeight, m_latentBias);
  return {out.narrow(1, 0, m_config.latent), out.narrow(1, m_config.latent, m_config.latent)};
}

torch::Tensor Net::decode(const torch::Tensor& latent, const torch::Tensor& control,
                          const torch::Tensor& mask) const {
  const auto repeated = latent.unsqueeze(1).expand({-1, control.size(1), -1});
  const auto frames = m_decoder->forward(torch::cat({control, repeated}, 2), reversedFrames(mask));
  return torch::nn::functional::linear(frames, m_poseWeight, m_poseBias);
}

torch::Tensor Net::noise() const {
  return m_config.gaussian() ? (0.5 * m_logVariance).exp() : torch::Tensor();
}

/// [B, T]: mean over channels of the squared error; of a Gaussian decoder, nats.
torch::Tensor Net::errorPerFrame(const torch::Tensor& pose, const torch::Tensor& mean) const {
  const auto squared = (pose - mean).square();
  if (!m_config.gaussian()) return squared.mean(2);
  const double constant = std::log(2.0 * std::numbers::pi);
  return 0.5 * (squared * (-m_logVariance).exp() + m_logVariance + constant).sum(2);
}

double Net::kldWeight(const TrainingBatch& batch) const {
  if (!batch.draws.defined() || m_config.kldWarmupSteps == 0) return m_config.kldWeight;
  return m_config.kldWeight *
         std::min(1.0, static_cast<double>(batch.step) / m_config.kldWarmupSteps);
}

Loss Net::loss(const TrainingBatch& batch) {
  const Posterior posterior = encode(batch.seenPose(), batch.control, batch.mask);
  torch::Tensor latent = posterior.mean;
  if (batch.draws.defined()) latent = latent + (0.5 * posterior.logVariance).exp() * batch.draws;
  const auto mean = decode(latent, batch.control, batch.mask);
  const auto reconstruction = (errorPerFrame(batch.pose, mean) * batch.mask).sum();
  const auto kld = kldWeight(batch) * divergence(posterior).sum();
  return {reconstruction + kld, {{"reconstruction", reconstruction}, {"kld", kld}}};
}

}  // namespace marey::vae

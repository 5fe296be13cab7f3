#include "rnn/net.h"

#include <cmath>

#include <ATen/CPUGeneratorImpl.h>

namespace marey::rnn {

Net::Net(const Config& config, uint64_t seed) : m_config(config) {
  auto generator = at::detail::createCPUGenerator(seed);
  const int64_t h = config.hidden, rows = (config.cell == "lstm" ? 4 : 3) * h;
  const double bound = 1.0 / std::sqrt(static_cast<double>(h));
  const auto drawn = [&](const std::string& name, std::vector<int64_t> shape) {
    return register_parameter(name, torch::rand(shape, generator) * (2.0 * bound) - bound);
  };
  for (int layer = 0; layer < config.layers; ++layer) {
    const std::string suffix = "_l" + std::to_string(layer);
    m_weights.push_back(drawn("weight_ih" + suffix, {rows, layer == 0 ? config.inputs() : h}));
    m_weights.push_back(drawn("weight_hh" + suffix, {rows, h}));
    m_weights.push_back(drawn("bias_ih" + suffix, {rows}));
    m_weights.push_back(drawn("bias_hh" + suffix, {rows}));
  }
  m_outWeight = drawn("out_weight", {config.poseDim, h});
  m_outBias = drawn("out_bias", {config.poseDim});
}

Objective Net::objective() const {
  return {.name = "squared error", .unit = "squared deviations per frame"};
}

torch::Tensor Net::windowsOf(const torch::Tensor& controls) const {
  const int64_t rows = m_config.past + 1 + m_config.lookahead;
  // [B, T, C, rows] -> frame by frame.
  return controls.unfold(1, rows, 1).transpose(2, 3).flatten(2);
}

torch::Tensor Net::poses(const torch::Tensor& inputs, State& state) const {
  if (!state.hidden.defined())
    state.hidden =
        torch::zeros({m_config.layers, inputs.size(0), m_config.hidden}, inputs.options());
  torch::Tensor seen;
  if (m_config.cell == "lstm") {
    if (!state.cell.defined()) state.cell = torch::zeros_like(state.hidden);
    std::tie(seen, state.hidden, state.cell) =
        torch::lstm(inputs, {state.hidden, state.cell}, m_weights, true, m_config.layers, 0.0,
                    is_training(), false, true);
  } else {
    std::tie(seen, state.hidden) = torch::gru(inputs, state.hidden, m_weights, true,
                                              m_config.layers, 0.0, is_training(), false, true);
  }
  return torch::nn::functional::linear(seen, m_outWeight, m_outBias);
}

torch::Tensor Net::fedPoses(const TrainingBatch& batch, const torch::Tensor& windows) const {
  State state;
  const int64_t first = context() - 1, frames = windows.size(1);
  const auto before = batch.seenPose().narrow(1, first, frames);
  if (!batch.own.defined()) return poses(torch::cat({windows, before}, 2), state);
  std::vector<torch::Tensor> made;
  for (int64_t t = 0; t < frames; ++t) {
    auto pose = before.narrow(1, t, 1);
    if (t > 0)
      pose = torch::where(batch.own.narrow(1, first + t, 1).unsqueeze(2) > 0.5, made.back(), pose);
    made.push_back(poses(torch::cat({windows.narrow(1, t, 1), pose}, 2), state));
  }
  return torch::cat(made, 1);
}

Loss Net::loss(const TrainingBatch& batch) {
  const auto windows = windowsOf(batch.control);
  State state;
  const auto made = m_config.feedback ? fedPoses(batch, windows) : poses(windows, state);
  const auto wanted = batch.pose.narrow(1, context(), made.size(1));
  return {((made - wanted).square().sum(-1) * scoredMask(batch)).sum()};
}

}  // namespace marey::rnn

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

torch::Tensor Net::poses(const torch::Tensor& windows, State& state) const {
  if (!state.hidden.defined())
    state.hidden =
        torch::zeros({m_config.layers, windows.size(0), m_config.hidden}, windows.options());
  torch::Tensor seen;
  if (m_config.cell == "lstm") {
    if (!state.cell.defined()) state.cell = torch::zeros_like(state.hidden);
    std::tie(seen, state.hidden, state.cell) =
        torch::lstm(windows, {state.hidden, state.cell}, m_weights, true, m_config.layers, 0.0,
                    is_training(), false, true);
  } else {
    std::tie(seen, state.hidden) = torch::gru(windows, state.hidden, m_weights, true,
                                              m_config.layers, 0.0, is_training(), false, true);
  }
  return torch::nn::functional::linear(seen, m_outWeight, m_outBias);
}

Loss Net::loss(const TrainingBatch& batch) {
  State state;
  const auto made = poses(windowsOf(batch.control), state);
  const auto wanted = batch.pose.narrow(1, context(), made.size(1));
  return {((made - wanted).square().sum(-1) * scoredMask(batch)).sum()};
}

}  // namespace marey::rnn

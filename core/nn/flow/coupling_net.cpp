#include <cmath>
#include <utility>

#include "base/error.h"
#include "nn/flow/flow.h"

namespace marey::nn {
namespace {

int64_t gatesOf(const std::string& cell) {
  if (cell == "lstm") return 4;
  if (cell == "gru") return 3;
  if (cell == "feedforward") return 1;
  throw InputError({.path = "coupling net", .item = "cell"}, "lstm, gru or feedforward",
                   "'" + cell + "'");
}

}  // namespace

CouplingNet::CouplingNet(int64_t inputs, int64_t outputs, CouplingNetSpec spec,
                         at::Generator& generator)
    : m_spec(std::move(spec)) {
  const int64_t rows = gatesOf(m_spec.cell) * m_spec.hidden;
  const bool recurrent = m_spec.cell != "feedforward";
  // PyTorch's start of recurrent layers: uniform in +-1/sqrt(hidden).
  const double bound = 1.0 / std::sqrt(static_cast<double>(m_spec.hidden));
  const auto add = [&](const std::string& name, std::vector<int64_t> shape) {
    const auto values = torch::rand(shape, generator) * (2.0 * bound) - bound;
    m_weights.push_back(register_parameter(name, values));
  };
  for (int64_t layer = 0; layer < m_spec.layers; ++layer) {
    const std::string suffix = "_l" + std::to_string(layer);
    add("weight_ih" + suffix, {rows, layer == 0 ? inputs : m_spec.hidden});
    if (recurrent) add("weight_hh" + suffix, {rows, m_spec.hidden});
    add("bias_ih" + suffix, {rows});
    if (recurrent) add("bias_hh" + suffix, {rows});
  }
  m_outWeight = register_parameter("out_weight", torch::zeros({outputs, m_spec.hidden}));
  m_outBias = register_parameter("out_bias", torch::zeros({outputs}));
}

torch::Tensor CouplingNet::hiddenOutput(const torch::Tensor& input, RecurrentState& state) const {
  if (m_spec.cell == "feedforward") {
    torch::Tensor x = input;
    for (int64_t layer = 0; layer < m_spec.layers; ++layer)
      x = torch::relu(
          torch::nn::functional::linear(x, m_weights[2 * layer], m_weights[2 * layer + 1]));
    return x;
  }
  if (!state.hidden.defined()) {
    state.hidden = torch::zeros({m_spec.layers, input.size(0), m_spec.hidden}, input.options());
    if (m_spec.cell == "lstm") state.cell = torch::zeros_like(state.hidden);
  }
  // The module's own parameters: a conversion to another type or device replaces their data,
  // not these handles.
  if (m_spec.cell == "lstm") {
    auto [output, hidden, cell] = torch::lstm(input, {state.hidden, state.cell}, m_weights, true,
                                              m_spec.layers, 0.0, is_training(), false, true);
    state = {hidden, cell};
    return output;
  }
  auto [output, hidden] = torch::gru(input, state.hidden, m_weights, true, m_spec.layers, 0.0,
                                     is_training(), false, true);
  state.hidden = hidden;
  return output;
}

std::vector<torch::Tensor> CouplingNet::weights() const {
  auto out = m_weights;
  out.push_back(m_outWeight);
  out.push_back(m_outBias);
  return out;
}

torch::Tensor CouplingNet::forward(const torch::Tensor& input, RecurrentState& state) const {
  return torch::nn::functional::linear(hiddenOutput(input, state), m_outWeight, m_outBias);
}

}  // namespace marey::nn

#include "nn/flow/net_pass.h"

#include <utility>

#include "nn/engine/training_recurrence.h"

namespace marey::nn {
namespace {

using torch::Tensor;

/// Rows of a matrix as panels of 32: [rows / 32][columns][32].
Tensor rowPanels(const Tensor& m) {
  return m.view({m.size(0) / kPanel, kPanel, m.size(1)}).transpose(1, 2).contiguous();
}

/// Columns as panels: [columns / 32][rows][32].
Tensor columnPanels(const Tensor& m) {
  return m.view({m.size(0), m.size(1) / kPanel, kPanel}).transpose(0, 1).contiguous();
}

/// to[rows[i]] += values[i]; no row comes twice.
void addRows(const Tensor& to, const Tensor& rows, const Tensor& values) {
  const int64_t width = to.size(1);
  const auto* index = rows.data_ptr<int64_t>();
  const auto* from = values.data_ptr<float>();
  auto* out = to.data_ptr<float>();
  at::parallel_for(0, rows.size(0), 64, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i)
      for (int64_t j = 0; j < width; ++j) out[index[i] * width + j] += from[i * width + j];
  });
}

TrainingLayer viewOf(const StepCall& call, const Tensor& gates, const Tensor& cells,
                     const Tensor& fromState, const Tensor& outputs) {
  const auto data = [](const Tensor& t) { return t.defined() ? t.data_ptr<float>() : nullptr; };
  return {.cell = cellNamed(call.net.cell),
          .frames = call.frames,
          .batch = call.batch,
          .hidden = call.net.hidden,
          .gates = data(gates),
          .cells = data(cells),
          .fromState = data(fromState),
          .outputs = data(outputs)};
}

}  // namespace

NetPass::NetPass(std::vector<Tensor> weights, std::shared_ptr<const StepCall> call)
    : m_weights(std::move(weights)), m_call(std::move(call)) {}

bool NetPass::recurrent() const {
  return m_call->net.cell != "feedforward";
}

const Tensor& NetPass::weight(size_t layer, size_t which) const {
  return m_weights[layer * perLayer() + which];
}

Tensor NetPass::firstProduct(const Tensor& passed) const {
  const StepCall& call = *m_call;
  const Tensor& w = weight(0, 0);
  call.inputs.narrow(1, 0, call.passed).copy_(passed);
  if (call.blocks.empty()) return at::mm(call.inputs, w.t());
  const int64_t rest = call.inputs.size(1) - call.passed;
  const auto dense = at::cat({w.narrow(1, 0, call.passed), w.narrow(1, w.size(1) - rest, rest)}, 1);
  auto out = at::mm(call.inputs, dense.t());
  for (const auto& block : call.blocks)
    addRows(out, block.rows,
            at::mm(block.values, w.narrow(1, block.column, block.values.size(1)).t()));
  return out;
}

Tensor NetPass::firstGradient(const Tensor& gates, const Tensor& passed) const {
  const StepCall& call = *m_call;
  call.inputs.narrow(1, 0, call.passed).copy_(passed);
  const auto dense = at::mm(gates.t(), call.inputs);
  if (call.blocks.empty()) return dense;
  std::vector<Tensor> parts{dense.narrow(1, 0, call.passed)};
  for (const auto& block : call.blocks)
    parts.push_back(at::mm(gates.index_select(0, block.rows).t(), block.values));
  parts.push_back(dense.narrow(1, call.passed, dense.size(1) - call.passed));
  return at::cat(parts, 1);
}

void NetPass::run(Layer& layer, size_t index) const {
  if (!recurrent()) {
    layer.outputs = layer.gates.add_(weight(index, 1)).relu_();
    return;
  }
  const int64_t hidden = m_call->net.hidden;
  layer.outputs = at::empty({layer.gates.size(0), hidden}, layer.gates.options());
  const bool lstm = m_call->net.cell == "lstm";
  (lstm ? layer.cells : layer.fromState) = at::empty_like(layer.outputs);
  const Tensor& inputBias = weight(index, 2);
  const Tensor& stateBias = weight(index, 3);
  auto bias = inputBias.clone();
  // The state's share of GRU's n lies inside its reset.
  const int64_t common = lstm ? bias.size(0) : 2 * hidden;
  bias.narrow(0, 0, common).add_(stateBias.narrow(0, 0, common));
  const auto ofN = stateBias.narrow(0, stateBias.size(0) - hidden, hidden);
  trainForward(viewOf(*m_call, layer.gates, layer.cells, layer.fromState, layer.outputs),
               rowPanels(weight(index, 1)).data_ptr<float>(), bias.data_ptr<float>(),
               ofN.data_ptr<float>());
}

Tensor NetPass::forward(const Tensor& passed) {
  Tensor input;
  for (size_t i = 0; i < static_cast<size_t>(m_call->net.layers); ++i) {
    Layer layer;
    layer.gates = i == 0 ? firstProduct(passed) : at::mm(input, weight(i, 0).t());
    run(layer, i);
    input = layer.outputs;
    m_layers.push_back(std::move(layer));
  }
  return input;
}

Tensor NetPass::recurrentGradient(const Layer& layer) const {
  const int64_t batch = m_call->batch, later = layer.gates.size(0) - batch,
                hidden = m_call->net.hidden;
  const auto before = layer.outputs.narrow(0, 0, later);
  const auto gates = layer.gates.narrow(0, batch, later);
  if (m_call->net.cell == "lstm") return at::mm(gates.t(), before);
  return at::cat({at::mm(gates.narrow(1, 0, 2 * hidden).t(), before),
                  at::mm(layer.fromState.narrow(0, batch, later).t(), before)});
}

void NetPass::backwardThrough(Layer& layer, size_t index, Tensor gradient,
                              std::vector<Tensor>& out) const {
  const size_t at = index * perLayer();
  if (!recurrent()) {
    layer.gates = at::threshold_backward(gradient, layer.outputs, 0);
    out[at + 1] = layer.gates.sum(0);
    return;
  }
  const int64_t hidden = m_call->net.hidden;
  auto bias = at::empty({4 * hidden}, layer.gates.options());
  gradient = gradient.contiguous();
  trainBackward(viewOf(*m_call, layer.gates, layer.cells, layer.fromState, layer.outputs),
                columnPanels(weight(index, 1)).data_ptr<float>(), gradient.data_ptr<float>(),
                bias.data_ptr<float>());
  out[at + 1] = recurrentGradient(layer);
  if (m_call->net.cell == "lstm") {
    out[at + 2] = bias;
    out[at + 3] = bias.clone();
    return;
  }
  out[at + 2] = bias.narrow(0, 0, 3 * hidden).clone();
  out[at + 3] = at::cat({bias.narrow(0, 0, 2 * hidden), bias.narrow(0, 3 * hidden, hidden)});
}

std::vector<Tensor> NetPass::backward(Tensor gradient, const Tensor& passed,
                                      Tensor passedGradient) {
  std::vector<Tensor> out(m_layers.size() * perLayer());
  for (size_t i = m_layers.size(); i-- > 0;) {
    Layer& layer = m_layers[i];
    backwardThrough(layer, i, gradient, out);
    if (i == 0) {
      out[0] = firstGradient(layer.gates, passed);
      passedGradient.addmm_(layer.gates, weight(0, 0).narrow(1, 0, m_call->passed));
    } else {
      out[i * perLayer()] = at::mm(layer.gates.t(), m_layers[i - 1].outputs);
      gradient = at::mm(layer.gates, weight(i, 0));
    }
    layer = {};
  }
  return out;
}

}  // namespace marey::nn

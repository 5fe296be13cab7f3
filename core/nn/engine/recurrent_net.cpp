#include "nn/engine/recurrent_net.h"

#include <algorithm>

namespace marey::nn {
namespace {

/// With so many rows for each, threads take rollouts of their own and never wait for each other;
/// with fewer they share the weights, which are then what takes the time to read.
constexpr long kRowsOfOwn = 24;

}  // namespace

RecurrentNet::RecurrentNet(const StackShape& shape, long outputs, Precision precision)
    : m_outputs(outputs),
      m_stack(shape, precision),
      m_output(shape.hidden, outputs, precision),
      m_bias(static_cast<size_t>(m_output.panels() * kPanel)) {}

void RecurrentNet::setOutput(std::span<const float> weights, std::span<const float> bias) {
  const auto hidden = static_cast<size_t>(m_stack.shape().hidden);
  for (size_t row = 0; row < bias.size(); ++row)
    m_output.set(static_cast<long>(row), 0, weights.subspan(row * hidden, hidden));
  std::copy(bias.begin(), bias.end(), m_bias.data());
}

void RecurrentNet::stepRows(Team& team, RowRange rows, std::span<const Inputs> inputs,
                            StackState& state, float* out) const {
  m_stack.step(team, rows, inputs, state);
  const Inputs hidden = m_stack.output(state);
  team.divide(m_output.panels(), [&](std::pair<long, long> panels) {
    const Inputs own{hidden.values + rows.begin * hidden.stride, hidden.stride, hidden.count};
    m_output.multiply({.inputs = {&own, 1},
                       .begin = panels.first,
                       .end = panels.second,
                       .start = m_bias.data() + panels.first * kPanel,
                       .out = out + rows.begin * outputStride() + panels.first * kPanel,
                       .outStride = outputStride(),
                       .rows = rows.count()});
  });
}

void RecurrentNet::step(std::span<const Inputs> inputs, StackState& state, float* out) const {
  const int threads = teamThreads();
  const bool own = state.rows >= threads * kRowsOfOwn;
  runTeam(threads, [&](Team team) {
    const auto [begin, end] = team.share(state.rows);
    Team alone;
    if (own)
      stepRows(alone, {begin, end}, inputs, state, out);
    else
      stepRows(team, {0, state.rows}, inputs, state, out);
  });
  m_stack.advance(state);
}

}  // namespace marey::nn

#include "nn/engine/recurrent_stack.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "nn/engine/stack_call.h"

namespace marey::nn {
namespace {

/// Rows whose gates are held at once: they stay in the first-level cache with a panel's sums.
constexpr long kRowsTogether = 96;

long groupsOf(long rows) {
  return (rows + kRowsTogether - 1) / kRowsTogether;
}

}  // namespace

Cell cellNamed(const std::string& name) {
  if (name == "lstm") return Cell::Lstm;
  if (name == "gru") return Cell::Gru;
  if (name == "feedforward") return Cell::Feedforward;
  throw InputError({.path = "recurrent stack", .item = "cell"}, "lstm, gru or feedforward",
                   "'" + name + "'");
}

long gatesOf(Cell cell) {
  return cell == Cell::Lstm ? 4 : cell == Cell::Gru ? 3 : 1;
}

FrameRows FrameRows::of(std::span<const long> lengths) {
  FrameRows out{{0}};
  auto active = static_cast<long>(lengths.size());
  for (long t = 0; active > 0; ++t) {
    while (active > 0 && lengths[static_cast<size_t>(active - 1)] <= t) --active;
    if (active > 0) out.first.push_back(out.first.back() + active);
  }
  return out;
}

RecurrentStack::RecurrentStack(const StackShape& shape, Precision precision)
    // The last term keeps rows from falling on the same sets of the first-level cache.
    : m_shape(shape), m_hiddenStride((shape.hidden + kPanel - 1) / kPanel * kPanel + kLanes) {
  const bool recurrent = shape.cell != Cell::Feedforward;
  for (long i = 0; i < shape.layers; ++i) {
    const long inputs = i == 0 ? shape.inputs : shape.hidden;
    m_layers.push_back({PackedMatrix(inputs + (recurrent ? shape.hidden : 0), columns(), precision),
                        AlignedFloats(static_cast<size_t>(columns())), inputs});
  }
}

/// Column of a gate's unit: blocks of units, within them gate by gate.
long RecurrentStack::column(long gate, long unit) const {
  const long units = blockUnits();
  return unit / units * blockPanels() * kPanel + gate * units + unit % units;
}

void RecurrentStack::setLayer(long index, const LayerWeights& w) {
  Layer& layer = m_layers[static_cast<size_t>(index)];
  const long gates = gatesOf(m_shape.cell), h = m_shape.hidden;
  const bool gru = m_shape.cell == Cell::Gru, recurrent = !w.recurrent.empty();
  for (long row = 0; row < gates * h; ++row) {
    const auto at = static_cast<size_t>(row);
    // GRU: the reset gate scales what the state gives to n, which therefore has a group to itself.
    const long gate = row / h, unit = row % h, fromState = gru && gate == 2 ? 3 : gate;
    const auto width = static_cast<size_t>(layer.inputs);
    layer.weights.set(column(gate, unit), 0, w.input.subspan(at * width, width));
    layer.bias.data()[column(gate, unit)] += w.inputBias[at];
    if (!recurrent) continue;
    layer.weights.set(column(fromState, unit), layer.inputs,
                      w.recurrent.subspan(at * static_cast<size_t>(h), static_cast<size_t>(h)));
    layer.bias.data()[column(fromState, unit)] += w.recurrentBias[at];
  }
}

std::vector<float> RecurrentStack::inputWeights(long index) const {
  const Layer& layer = m_layers[static_cast<size_t>(index)];
  const long rows = gatesOf(m_shape.cell) * m_shape.hidden;
  std::vector<float> out(static_cast<size_t>(rows * layer.inputs));
  for (long row = 0; row < rows; ++row)
    layer.weights.get(column(row / m_shape.hidden, row % m_shape.hidden), 0,
                      std::span(out).subspan(static_cast<size_t>(row * layer.inputs),
                                             static_cast<size_t>(layer.inputs)));
  return out;
}

std::vector<float> RecurrentStack::recurrentWeights(long index) const {
  const Layer& layer = m_layers[static_cast<size_t>(index)];
  const long h = m_shape.hidden, rows = gatesOf(m_shape.cell) * h;
  std::vector<float> out(static_cast<size_t>(rows * h));
  for (long row = 0; row < rows; ++row) {
    const long gate = m_shape.cell == Cell::Gru && row / h == 2 ? 3 : row / h;
    layer.weights.get(column(gate, row % h), layer.inputs,
                      std::span(out).subspan(static_cast<size_t>(row * h), static_cast<size_t>(h)));
  }
  return out;
}

size_t RecurrentStack::bytes() const {
  size_t out = 0;
  for (const Layer& layer : m_layers) out += layer.weights.bytes();
  return out;
}

StackState RecurrentStack::start(long rows) const {
  StackState out{.rows = rows};
  const AlignedFloats zeros(static_cast<size_t>(rows * m_hiddenStride));
  const auto layers = static_cast<size_t>(m_shape.layers);
  out.next.assign(layers, zeros);
  if (m_shape.cell != Cell::Feedforward) out.hidden.assign(layers, zeros);
  if (m_shape.cell == Cell::Lstm) out.cell.assign(layers, zeros);
  return out;
}

void RecurrentStack::copyRow(const StackState& from, long fromRow, StackState& to,
                             long toRow) const {
  const auto copy = [&](const std::vector<AlignedFloats>& a, std::vector<AlignedFloats>& b) {
    for (size_t i = 0; i < a.size(); ++i)
      std::copy_n(a[i].data() + fromRow * m_hiddenStride, m_hiddenStride,
                  b[i].data() + toRow * m_hiddenStride);
  };
  copy(from.hidden, to.hidden);
  copy(from.cell, to.cell);
}

void RecurrentStack::run(const Layer& layer, const Call& call, std::pair<long, long> blocks) const {
  const Kernels& k = kernels();
  alignas(64) std::array<float, kRowsTogether * 2 * kPanel> scratch;
  const long rows = call.rows.count(), groups = groupsOf(rows);
  for (long g = 0; g < groups; ++g) {
    const RowRange part{call.rows.begin + g * rows / groups,
                        call.rows.begin + (g + 1) * rows / groups};
    const auto inputs = call.inputs.from(part.begin);
    for (long b = blocks.first; b < blocks.second; ++b) {
      const long unit = b * blockUnits(), width = blockPanels() * kPanel;
      const bool plain = m_shape.cell == Cell::Feedforward;
      float* hidden = call.hidden + part.begin * m_hiddenStride + unit;
      layer.weights.multiply({.inputs = {inputs.data(), call.inputs.size()},
                              .first = call.first,
                              .begin = b * blockPanels(),
                              .end = (b + 1) * blockPanels(),
                              .start = call.start + part.begin * call.startStride + b * width,
                              .startStride = call.startStride,
                              .out = plain ? hidden : scratch.data(),
                              .outStride = plain ? m_hiddenStride : width,
                              .rows = part.count()});
      if (plain) {
        k.relu(hidden, m_hiddenStride, part.count());
        continue;
      }
      const long at = part.begin * m_hiddenStride + unit;
      const GateBlock block{.gates = scratch.data(),
                            .previous = call.previous + at,
                            .cell = call.cell == nullptr ? nullptr : call.cell + at,
                            .hidden = hidden,
                            .stride = m_hiddenStride,
                            .previousStride = m_hiddenStride,
                            .cellStride = m_hiddenStride,
                            .rows = part.count()};
      (m_shape.cell == Cell::Lstm ? k.lstm : k.gru)(block);
    }
  }
}

void RecurrentStack::step(Team& team, RowRange rows, std::span<const Inputs> inputs,
                          StackState& state) const {
  const bool recurrent = m_shape.cell != Cell::Feedforward;
  for (size_t i = 0; i < m_layers.size(); ++i) {
    Call call{.start = m_layers[i].bias.data(),
              .cell = m_shape.cell == Cell::Lstm ? state.cell[i].data() : nullptr,
              .hidden = state.next[i].data(),
              .rows = rows};
    if (i == 0)
      for (const Inputs& run : inputs) call.inputs.add(run);
    else
      call.inputs.add({state.next[i - 1].data(), m_hiddenStride, m_shape.hidden});
    if (recurrent) {
      call.previous = state.hidden[i].data();
      call.inputs.add({call.previous, m_hiddenStride, m_shape.hidden});
    }
    team.divide(blocks(), [&](std::pair<long, long> part) { run(m_layers[i], call, part); });
  }
}

Inputs RecurrentStack::output(const StackState& state) const {
  return {state.next.back().data(), m_hiddenStride, m_shape.hidden};
}

void RecurrentStack::advance(StackState& state) const {
  if (m_shape.cell != Cell::Feedforward) std::swap(state.hidden, state.next);
}

}  // namespace marey::nn

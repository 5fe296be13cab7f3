#include "nn/engine/training_recurrence.h"

#include <algorithm>

namespace marey::nn {
namespace {

/// out[r] = start[r] + inputs[r] * weights for the panels [begin, end) of packed weights.
struct PanelRange {
  const float* weights = nullptr;
  long inputs = 0;  ///< of the packed weights
  long begin = 0, end = 0;
};

void multiply(const PanelRange& range, const Inputs* runs, int count, const float* start,
              long startStride, float* out, long outStride, long rows) {
  const long size = range.inputs * kPanel;
  for (long i = range.begin; i < range.end; i += 2) {
    const int panels = i + 1 < range.end ? 2 : 1;
    const float* panel = range.weights + i * size;
    const float* next = i + panels < range.end ? panel + panels * size : range.weights;
    const long column = (i - range.begin) * kPanel;
    kernels().product({.inputs = runs,
                       .runs = count,
                       .panel = reinterpret_cast<const std::byte*>(panel),
                       .panels = panels,
                       .panelBytes = size * static_cast<long>(sizeof(float)),
                       .next = reinterpret_cast<const std::byte*>(next),
                       .start = start + column,
                       .startStride = startStride,
                       .out = out + column,
                       .outStride = outStride,
                       .rows = rows});
  }
}

/// Some sequences of a layer, frame by frame.
class Sequences {
 public:
  Sequences(const TrainingLayer& layer, const float* weights, std::pair<long, long> share)
      : m_layer(layer),
        m_weights(weights),
        m_first(share.first),
        m_rows(share.second - share.first) {}

  void forward(const float* bias, const float* stateBias) const {
    const TrainingLayer& l = m_layer;
    for (long t = 0; m_rows > 0 && t < l.frames; ++t) {
      TrainingRows rows = rowsAt(t);
      rows.bias = bias;
      rows.hidden = l.outputs + at(t);
      products(t, rows, stateBias);
      if (l.cell == Cell::Lstm)
        kernels().lstmForward(rows);
      else
        kernels().gruForward(rows);
    }
  }

  void backward(float* gradient, float* biasGradient) const {
    const TrainingLayer& l = m_layer;
    AlignedFloats cells(static_cast<size_t>(l.cell == Cell::Lstm ? m_rows * l.hidden : 0));
    for (long t = l.frames; m_rows > 0 && t-- > 0;) {
      TrainingRows rows = rowsAt(t);
      rows.biasGradient = biasGradient;
      rows.gradient = gradient + at(t);
      if (l.cell == Cell::Lstm) {
        rows.carried = cells.data();
        kernels().lstmBackward(rows);
      } else {
        rows.carried = t == 0 ? nullptr : gradient + at(t - 1);
        kernels().gruBackward(rows);
      }
      if (t > 0) toEarlier(t, rows, gradient + at(t - 1));
    }
  }

 private:
  long at(long t) const { return (t * m_layer.batch + m_first) * m_layer.hidden; }

  TrainingRows rowsAt(long t) const {
    const TrainingLayer& l = m_layer;
    const bool lstm = l.cell == Cell::Lstm;
    const float* state = lstm ? l.cells : l.outputs;
    return {.gates = l.gates + (t * l.batch + m_first) * l.width(),
            .previous = t == 0 ? nullptr : state + at(t - 1),
            .cell = lstm ? l.cells + at(t) : nullptr,
            .fromState = lstm ? nullptr : l.fromState + at(t),
            .gateStride = l.width(),
            .units = l.hidden,
            .rows = m_rows};
  }

  /// What the frame before gives to the gates.
  void products(long t, const TrainingRows& rows, const float* stateBias) const {
    const TrainingLayer& l = m_layer;
    const long all = l.width() / kPanel, ofN = l.hidden / kPanel;
    if (l.cell == Cell::Gru && t == 0)
      for (long r = 0; r < m_rows; ++r)
        std::copy_n(stateBias, l.hidden, rows.fromState + r * l.hidden);
    if (t == 0) return;
    const Inputs state{l.outputs + at(t - 1), l.hidden, l.hidden};
    const long shared = l.cell == Cell::Gru ? all - ofN : all;
    multiply({m_weights, l.hidden, 0, shared}, &state, 1, rows.gates, l.width(), rows.gates,
             l.width(), m_rows);
    if (l.cell == Cell::Gru)
      multiply({m_weights, l.hidden, shared, all}, &state, 1, stateBias, 0, rows.fromState,
               l.hidden, m_rows);
  }

  /// Adds to the gradient by the outputs of the frame before.
  void toEarlier(long t, const TrainingRows& rows, float* gradient) const {
    const TrainingLayer& l = m_layer;
    const PanelRange range{m_weights, l.width(), 0, l.hidden / kPanel};
    const bool gru = l.cell == Cell::Gru;
    const Inputs runs[] = {{rows.gates, l.width(), gru ? 2 * l.hidden : l.width()},
                           {gru ? l.fromState + at(t) : nullptr, l.hidden, l.hidden}};
    multiply(range, runs, gru ? 2 : 1, gradient, l.hidden, gradient, l.hidden, m_rows);
  }

  const TrainingLayer& m_layer;
  const float* m_weights;
  long m_first, m_rows;
};

}  // namespace

void trainForward(const TrainingLayer& layer, const float* weights, const float* bias,
                  const float* stateBias) {
  runTeam(teamThreads(), [&](Team team) {
    Sequences(layer, weights, team.share(layer.batch)).forward(bias, stateBias);
  });
}

void trainBackward(const TrainingLayer& layer, const float* weights, float* gradient,
                   float* biasGradient) {
  const int threads = teamThreads();
  const long width = 4 * layer.hidden;
  // Each member adds up its own; then all of them are added in one order.
  AlignedFloats sums(static_cast<size_t>(threads * width));
  runTeam(threads, [&](Team team) {
    Sequences(layer, weights, team.share(layer.batch))
        .backward(gradient, sums.data() + team.rank() * width);
  });
  std::fill_n(biasGradient, width, 0.f);
  for (long i = 0; i < threads; ++i)
    for (long j = 0; j < width; ++j) biasGradient[j] += sums.data()[i * width + j];
}

}  // namespace marey::nn

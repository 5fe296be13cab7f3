// A recurrent stack and a linear layer on what comes out of it, on packed weights: what recurrent
// families that make motion frame by frame run on. No libtorch type appears here.
//
// What comes out for a row is the same bits whatever other rows are there and however many threads
// work.
#pragma once

#include <span>

#include "nn/engine/recurrent_stack.h"

namespace marey::nn {

class RecurrentNet {
 public:
  RecurrentNet(const StackShape& shape, long outputs, Precision precision);
  void setLayer(long layer, const LayerWeights& weights) { m_stack.setLayer(layer, weights); }
  /// `weights` [outputs, hidden] row-major, `bias` [outputs].
  void setOutput(std::span<const float> weights, std::span<const float> bias);

  long outputs() const { return m_outputs; }
  /// Floats from one row of outputs to the next.
  long outputStride() const { return m_output.panels() * kPanel; }
  StackState start(long rows) const { return m_stack.start(rows); }
  /// The next frame of all rows of the state: `inputs` from row 0 on, `out` [rows, outputStride].
  void step(std::span<const Inputs> inputs, StackState& state, float* out) const;

 private:
  void stepRows(Team& team, RowRange rows, std::span<const Inputs> inputs, StackState& state,
                float* out) const;

  long m_outputs;
  RecurrentStack m_stack;
  PackedMatrix m_output;
  AlignedFloats m_bias;
};

}  // namespace marey::nn

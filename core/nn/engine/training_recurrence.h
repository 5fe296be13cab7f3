// One recurrent layer (LSTM or GRU, PyTorch's definitions) over sequences that start at zero, with
// its gradient. What the layer's inputs give to the gates is computed outside, for all frames at
// once. No libtorch type appears here.
//
// Matrices are time-major: sequence b at frame t is row t * batch + b, so that a frame's rows lie
// together. The members of a team take sequences, and never wait for each other.
#pragma once

#include "nn/engine/recurrent_stack.h"

namespace marey::nn {

struct TrainingLayer {
  Cell cell = Cell::Lstm;  ///< Lstm or Gru
  long frames = 0, batch = 0;
  long hidden = 0;             ///< a multiple of kPanel
  float* gates = nullptr;      ///< [frames * batch, gates * hidden]: 4 gates, GRU 3
  float* cells = nullptr;      ///< [frames * batch, hidden]; LSTM
  float* fromState = nullptr;  ///< [frames * batch, hidden]; GRU: what the state gives to n
  float* outputs = nullptr;    ///< [frames * batch, hidden]

  long width() const { return gatesOf(cell) * hidden; }
};

/// Gates come in without biases and are left as activations; fills cells (or fromState) and
/// outputs. `weights`: the recurrent weights [gates * hidden, hidden] in panels of 32 gates,
/// [panel][hidden][32]. `bias` [gates * hidden]; `stateBias` [hidden]: the one inside GRU's reset.
void trainForward(const TrainingLayer& layer, const float* weights, const float* bias,
                  const float* stateBias);

/// Turns the gates into gradients by what came in (and fromState into its own). `weights` in panels
/// of 32 units, [panel][gates * hidden][32]. `gradient` [frames * batch, hidden]: of the loss by
/// the outputs; overwritten. `biasGradient` [4 * hidden]: LSTM by gate; GRU r, z, n, state's n.
void trainBackward(const TrainingLayer& layer, const float* weights, float* gradient,
                   float* biasGradient);

}  // namespace marey::nn

// Recurrent layers that go through whole sequences both ways, on packed weights; each layer sees
// both ways of the one below it. No libtorch type appears here.
//
// What comes out for a sequence is the same bits whatever other sequences are there and however
// many threads work (recurrent_stack.h).
#pragma once

#include "nn/engine/recurrent_stack.h"

namespace marey::nn {

enum class Way { Ahead, Back };

class BidirectionalStack {
 public:
  /// `shape.hidden`: units each way.
  BidirectionalStack(const StackShape& shape, Precision precision);
  /// Weights of a layer one way; those of inputs [gates * hidden, shape.inputs], or
  /// [gates * hidden, 2 * hidden] above the first layer.
  void setLayer(long layer, Way way, const LayerWeights& weights);

  long outputs() const { return 2 * m_shape.hidden; }

  /// Memory of `forward`, kept from call to call.
  struct Work {
    RecurrentStack::Work stack;
    AlignedFloats reversed;   ///< [rows, inputs of a layer]
    AlignedFloats odd, even;  ///< [rows, stride]: outputs of alternate layers
  };
  /// `inputs` [frames.rows(), shape.inputs] -> [frames.rows(), outputs()] within `work`: what goes
  /// ahead, then what comes back. `between` is called every few frames and may throw.
  Inputs forward(const FrameRows& frames, const Inputs& inputs, Work& work,
                 const std::function<void()>& between) const;

 private:
  struct Layer {
    RecurrentStack ahead, back;
  };
  StackShape m_shape;
  std::vector<Layer> m_layers;
};

}  // namespace marey::nn

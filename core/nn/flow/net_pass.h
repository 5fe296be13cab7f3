// Forward and backward pass of a coupling net over whole sequences, without autograd. Internal.
#pragma once

#include "nn/flow/coupling_step.h"

namespace marey::nn {

/// What a pass keeps for its gradient.
class NetPass {
 public:
  NetPass(std::vector<torch::Tensor> weights, std::shared_ptr<const StepCall> call);

  /// `passed` [rows, passed channels] -> the last layer's outputs [rows, hidden].
  torch::Tensor forward(const torch::Tensor& passed);
  /// From the gradient by the outputs (overwritten): the gradients by the layers' weights, in their
  /// order. Adds the one by `passed` to `passedGradient`, which may be part of a wider matrix.
  std::vector<torch::Tensor> backward(torch::Tensor gradient, const torch::Tensor& passed,
                                      torch::Tensor passedGradient);

 private:
  struct Layer {
    torch::Tensor gates;      ///< activations; after backward gradients
    torch::Tensor cells;      ///< LSTM
    torch::Tensor fromState;  ///< GRU
    torch::Tensor outputs;
  };
  bool recurrent() const;
  size_t perLayer() const { return recurrent() ? 4 : 2; }
  const torch::Tensor& weight(size_t layer, size_t which) const;
  torch::Tensor firstProduct(const torch::Tensor& passed) const;
  torch::Tensor firstGradient(const torch::Tensor& gates, const torch::Tensor& passed) const;
  void run(Layer& layer, size_t index) const;
  torch::Tensor recurrentGradient(const Layer& layer) const;
  void backwardThrough(Layer& layer, size_t index, torch::Tensor gradient,
                       std::vector<torch::Tensor>& out) const;

  std::vector<torch::Tensor> m_weights;
  std::shared_ptr<const StepCall> m_call;
  std::vector<Layer> m_layers;
};

}  // namespace marey::nn

// The RNN baseline in training, on libtorch: control in, poses out (Henter et al. 2020, Sec. 4.3).
#pragma once

#include "rnn/config.h"

#include "model/gradient/trainable.h"

namespace marey::rnn {

class Net : public TrainableModel {
 public:
  /// Random weights from `seed`: uniform within 1/sqrt(hidden), as PyTorch starts such layers.
  Net(const Config& config, uint64_t seed);

  // TrainableModel
  Objective objective() const override;
  int64_t context() const override { return m_config.past; }
  int64_t lookahead() const override { return m_config.lookahead; }
  bool seesOwnPoses() const override { return m_config.feedback; }
  Loss loss(const TrainingBatch& batch) override;

  /// Hidden and cell state, [layers, B, hidden]; undefined: zero. GRUs have no cell.
  struct State {
    torch::Tensor hidden, cell;
  };
  /// Poses [B, T, D] of T frames after each other, each seeing `inputs` [B, T, inputs]: its window
  /// of control, and with feedback the pose before it.
  torch::Tensor poses(const torch::Tensor& inputs, State& state) const;
  /// What every frame sees of controls [B, past + T + lookahead, C]: [B, T, controlInputs].
  torch::Tensor windowsOf(const torch::Tensor& controls) const;

  const Config& config() const { return m_config; }

 private:
  /// With feedback: where the batch says so, the pose before a frame is the one that was made.
  /// Gradients go through it.
  torch::Tensor fedPoses(const TrainingBatch& batch, const torch::Tensor& windows) const;

  Config m_config;
  std::vector<torch::Tensor> m_weights;  ///< by layer: input, recurrent, their biases
  torch::Tensor m_outWeight, m_outBias;
};

}  // namespace marey::rnn

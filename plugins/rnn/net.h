// The RNN baseline in training, on libtorch: control in, poses out (Henter et al. 2020, Sec. 4.3).
#pragma once

#include "rnn/config.h"

#include "model/trainable.h"

namespace marey::rnn {

class Net : public TrainableModel {
 public:
  /// Random weights from `seed`: uniform within 1/sqrt(hidden), as PyTorch starts such layers.
  Net(const Config& config, uint64_t seed);

  // TrainableModel
  Objective objective() const override;
  int64_t context() const override { return m_config.past; }
  int64_t lookahead() const override { return m_config.lookahead; }
  Loss loss(const TrainingBatch& batch) override;

  /// Hidden and cell state, [layers, B, hidden]; undefined: zero. GRUs have no cell.
  struct State {
    torch::Tensor hidden, cell;
  };
  /// Poses [B, T, D] of T frames after each other, each seeing `windows` [B, T, inputs].
  torch::Tensor poses(const torch::Tensor& windows, State& state) const;
  /// What every frame sees of controls [B, past + T + lookahead, C]: [B, T, inputs].
  torch::Tensor windowsOf(const torch::Tensor& controls) const;

  const Config& config() const { return m_config; }

 private:
  Config m_config;
  std::vector<torch::Tensor> m_weights;  ///< by layer: input, recurrent, their biases
  torch::Tensor m_outWeight, m_outBias;
};

}  // namespace marey::rnn

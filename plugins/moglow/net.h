// The network of MoGlow: an optional linear base, and a flow whose coupling nets see the pose
// history and the control. Works on standardised values.
#pragma once

#include <memory>
#include <optional>

#include "model/trainable.h"
#include "moglow/config.h"
#include "moglow/linear_base.h"
#include "nn/flow.h"

namespace marey::moglow {

class Net : public TrainableModel {
 public:
  /// Random weights from `seed`.
  Net(const Config& config, uint64_t seed);

  // TrainableModel
  int64_t context() const override { return m_config.tau; }
  int64_t lookahead() const override { return m_config.lookahead; }
  torch::Tensor logLikelihood(const TrainingBatch& batch, at::Generator* dropout) override;
  Json initialise(const TrainingFrames& frames) override;

  /// Conditioning pieces of one frame or a run of frames.
  struct Context {
    torch::Tensor history;  ///< [B, T, tau * D], oldest first
    torch::Tensor control;  ///< [B, T, (tau + 1 + lookahead) * C]
  };
  /// Slices sequences: poses [B, tau + T, D] and controls [B, tau + T + lookahead, C].
  Context contextOf(const torch::Tensor& poses, const torch::Tensor& controls) const;
  /// keep [B, T, tau] hides history frames from the nets (undefined: all are seen).
  nn::Transformed toLatent(const torch::Tensor& x, const Context& context,
                           const torch::Tensor& keep, nn::FlowState& state) const;
  torch::Tensor toData(const torch::Tensor& z, const Context& context, nn::FlowState& state) const;

  const Config& config() const { return m_config; }
  nn::Flow& flow() { return *m_flow; }

 private:
  torch::Tensor conditioning(const Context& context, const torch::Tensor& keep) const;

  Config m_config;
  std::shared_ptr<nn::Flow> m_flow;
  std::shared_ptr<LinearBase> m_base;            ///< null without a base
  torch::Tensor m_historyMean, m_historyWhiten;  ///< [D], [D, D]: what the nets see of poses
};

}  // namespace marey::moglow

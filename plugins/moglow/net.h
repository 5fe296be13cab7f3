// The network of MoGlow: an optional base, and a flow whose coupling nets see the pose history
// and the control. Works on standardised values.
#pragma once

#include <memory>
#include <utility>

#include "model/trainable.h"
#include "moglow/config.h"
#include "moglow/feet_layer.h"
#include "moglow/pose_base.h"
#include "nn/flow.h"

namespace marey::moglow {

class Net : public TrainableModel {
 public:
  /// Random weights from `seed`. Throws InputError when the body does not suit the base.
  Net(const Config& config, const BodyFacts& body, uint64_t seed);

  // TrainableModel
  int64_t context() const override { return m_config.tau; }
  int64_t lookahead() const override { return m_config.lookahead; }
  torch::Tensor logLikelihood(const TrainingBatch& batch, at::Generator* dropout) override;
  Json initialise(const TrainingFrames& frames) override;

  /// Conditioning of a run of frames.
  struct Context {
    torch::Tensor history;  ///< [B, T, tau * D], oldest first
    torch::Tensor control;  ///< [B, T, (tau + 1 + lookahead) * C]
    torch::Tensor keep;     ///< [B, T, tau]: 0 hides a history frame from the nets; undefined: none
  };
  /// Slices sequences: poses [B, tau + T, D] (the last is not history) and controls
  /// [B, tau + T + lookahead, C].
  Context contextOf(const torch::Tensor& poses, const torch::Tensor& controls) const;
  nn::Transformed toLatent(const torch::Tensor& x, const Context& context,
                           nn::FlowState& state) const;
  torch::Tensor toData(const torch::Tensor& z, const Context& context, nn::FlowState& state) const;

  const Config& config() const { return m_config; }

 private:
  torch::Tensor plainConditioning(const Context& context) const;
  /// Innovations [B, T, D] as the channels that pass the flow by and those that it models.
  std::pair<torch::Tensor, torch::Tensor> split(const torch::Tensor& innovation) const;
  /// What a base foresees, as sequences: what the nets see [B, T, F] and the feet's freedom.
  struct Seen {
    torch::Tensor features, freedom;
  };
  static Seen seenIn(const Foresight& foresight, int64_t batch, int64_t frames);
  /// What the flow's nets see: [B, T, F], the passed channels included.
  torch::Tensor seenByFlow(const Seen& seen, const torch::Tensor& passed) const;
  Context contextAt(const TrainingFrames& frames, const torch::Tensor& rows) const;

  Config m_config;
  std::shared_ptr<nn::Flow> m_flow;
  std::shared_ptr<PoseBase> m_base;  ///< null without a base
  std::shared_ptr<FeetLayer> m_feet;  ///< null where the flow models all
};

}  // namespace marey::moglow

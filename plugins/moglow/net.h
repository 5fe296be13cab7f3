// The network of MoGlow: an optional base, and a flow whose coupling nets see the pose history
// and the control. Works on standardised values.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "model/gradient/trainable.h"
#include "moglow/config.h"
#include "moglow/pose_base.h"
#include "nn/flow/fast_flow.h"

namespace marey::moglow {

class Net : public TrainableModel {
 public:
  /// Random weights from `seed`. Throws InputError when the body does not suit the base.
  Net(const Config& config, const BodyFacts& body, uint64_t seed);

  // TrainableModel
  int64_t context() const override { return m_config.tau; }
  int64_t lookahead() const override { return m_config.lookahead; }
  Objective objective() const override;
  torch::Tensor draw(const TrainingBatch& batch, at::Generator& generator) const override;
  Loss loss(const TrainingBatch& batch) override;
  Json initialise(const TrainingFrames& frames) override;
  double observationFloorM() const override { return 1e-3 * m_config.observationFloorMm; }
  torch::Tensor poseDerivatives(const TrainingFrames& frames, int64_t count) override;

  /// Log-density in nats [B, W - tau - lookahead] of frames tau .. W - lookahead - 1.
  torch::Tensor logLikelihood(const TrainingBatch& batch);

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
  /// The exact inverse of toLatent.
  torch::Tensor toData(const torch::Tensor& z, const Context& context, nn::FlowState& state) const;
  /// The same without the observation noise of a base: what samples are.
  torch::Tensor toMotion(const torch::Tensor& z, const Context& context,
                         nn::FlowState& state) const;

  const Config& config() const { return m_config; }

 private:
  using FlowPass = std::function<nn::Transformed(const torch::Tensor& x,
                                                 const nn::FlowConditioning& conditioning)>;
  /// To latent, with the flow run by `pass`.
  nn::Transformed toLatentBy(const FlowPass& pass, const torch::Tensor& x,
                             const Context& context) const;
  torch::Tensor toDataBy(const PoseBase* base, const torch::Tensor& z, const Context& context,
                         nn::FlowState& state) const;
  torch::Tensor plainConditioning(const Context& context) const;
  /// Innovations [B, T, D] as the channels that pass the flow by and those that it models.
  std::pair<torch::Tensor, torch::Tensor> split(const torch::Tensor& innovation) const;
  /// What the flow's nets see: [B, T, F], the passed channels included.
  torch::Tensor seenBy(const Foresight& foresight, const torch::Tensor& passed) const;
  void fitBases(const TrainingFrames& frames, Json& facts);
  Context contextAt(const TrainingFrames& frames, const torch::Tensor& rows) const;

  Config m_config;
  std::shared_ptr<nn::Flow> m_flow;
  std::shared_ptr<PoseBase> m_base;    ///< null without a base
  std::shared_ptr<PoseBase> m_motion;  ///< that of samples; null where m_base is
};

}  // namespace marey::moglow

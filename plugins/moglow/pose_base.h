// The base of 'MG+': an exact layer below the flow that foresees the next pose from the history
// and the control. The flow models what the base cannot foresee.
#pragma once

#include <memory>
#include <vector>

#include "moglow/body_facts.h"
#include "moglow/config.h"
#include "nn/torch/torch.h"

namespace marey::moglow {

/// History and control of N frames, standardised.
struct BaseInput {
  torch::Tensor history;  ///< [N, tau * D], oldest frame first
  torch::Tensor control;  ///< [N, (tau + 1 + lookahead) * C], oldest first
  torch::Tensor keep;     ///< [N, tau]: 0 hides a history frame from the nets; undefined: none
};

/// What a base makes of one frame's conditioning; used by both directions.
struct Foresight {
  torch::Tensor features;            ///< [N, F]: what the coupling nets see
  std::vector<torch::Tensor> parts;  ///< the base's own
};

class PoseBase : public torch::nn::Module {
 public:
  virtual Foresight foresee(const BaseInput& input) const = 0;
  struct Innovation {
    torch::Tensor value;   ///< [N, D]
    torch::Tensor logDet;  ///< [N]
  };
  /// Standardised poses [N, D] <-> innovations.
  virtual Innovation toInnovation(const torch::Tensor& pose, const Foresight& foresight) const = 0;
  virtual torch::Tensor toPose(const torch::Tensor& innovation,
                               const Foresight& foresight) const = 0;
  /// Deterministic fit to standardised poses [N, D] with their inputs, seen through noise of
  /// standard deviations `noise` [D], standardised too; undefined: none.
  virtual void fit(const torch::Tensor& poses, const BaseInput& input,
                   const torch::Tensor& noise) = 0;
};

/// Null for configurations without a base. Throws InputError when the body does not suit it.
std::shared_ptr<PoseBase> makePoseBase(const Config& config, const BodyFacts& body);

}  // namespace marey::moglow

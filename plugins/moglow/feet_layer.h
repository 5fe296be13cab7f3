// What a network adds to the gates of the feet that pass the flow by: a shift and a scale of their
// normal values, given what the nets see. It grows with a foot's freedom: a foot in the air follows
// the body more closely than its gate says, while a held foot keeps its gate.
#pragma once

#include "nn/flow.h"

namespace marey::moglow {

class FeetLayer : public torch::nn::Module {
 public:
  /// `seen` conditioning values, `channels` values of feet. Starts as the identity.
  FeetLayer(int64_t seen, int64_t channels, int64_t hidden, at::Generator& generator);

  /// Gated values [B, T, channels] <-> latents, given what is seen [B, T, seen] and the freedom
  /// [B, T, channels] of each value, 0 .. 1.
  nn::Transformed toLatent(const torch::Tensor& gated, const torch::Tensor& seen,
                           const torch::Tensor& freedom) const;
  torch::Tensor toData(const torch::Tensor& latent, const torch::Tensor& seen,
                       const torch::Tensor& freedom) const;

 private:
  struct Affine {
    torch::Tensor shift, logScale;
  };
  Affine affineOf(const torch::Tensor& seen, const torch::Tensor& freedom) const;

  torch::Tensor m_inWeight, m_inBias, m_midWeight, m_midBias, m_outWeight, m_outBias;
};

}  // namespace marey::moglow

#include "moglow/feet_layer.h"

#include <cmath>

namespace marey::moglow {
namespace {

// Bounds of what the net may say: free-running motion must not run away with it.
constexpr double kLargestShift = 3.0;     ///< standard deviations
constexpr double kLargestLogScale = 1.5;  ///< a factor of 4.5

}  // namespace

FeetLayer::FeetLayer(int64_t seen, int64_t channels, int64_t hidden, at::Generator& generator) {
  const auto random = [&](const char* name, int64_t out, int64_t in) {
    return register_parameter(
        name, torch::randn({out, in}, generator) / std::sqrt(static_cast<double>(in)));
  };
  m_inWeight = random("in_weight", hidden, seen);
  m_inBias = register_parameter("in_bias", torch::zeros({hidden}));
  m_midWeight = random("mid_weight", hidden, hidden);
  m_midBias = register_parameter("mid_bias", torch::zeros({hidden}));
  m_outWeight = register_parameter("out_weight", torch::zeros({2 * channels, hidden}));
  m_outBias = register_parameter("out_bias", torch::zeros({2 * channels}));
}

FeetLayer::Affine FeetLayer::affineOf(const torch::Tensor& seen,
                                      const torch::Tensor& freedom) const {
  auto h = torch::linear(seen, m_inWeight, m_inBias).tanh();
  h = torch::linear(h, m_midWeight, m_midBias).tanh();
  const auto out = torch::linear(h, m_outWeight, m_outBias).chunk(2, -1);
  return {kLargestShift * (out[0] / kLargestShift).tanh() * freedom,
          kLargestLogScale * (out[1] / kLargestLogScale).tanh() * freedom};
}

nn::Transformed FeetLayer::toLatent(const torch::Tensor& gated, const torch::Tensor& seen,
                                    const torch::Tensor& freedom) const {
  const Affine a = affineOf(seen, freedom);
  return {(gated - a.shift) * (-a.logScale).exp(), -a.logScale.sum(-1)};
}

torch::Tensor FeetLayer::toData(const torch::Tensor& latent, const torch::Tensor& seen,
                                const torch::Tensor& freedom) const {
  const Affine a = affineOf(seen, freedom);
  return latent * a.logScale.exp() + a.shift;
}

}  // namespace marey::moglow

// The linear autoregressive base of 'MG+': one more exact layer of the flow. The flow above it
// models what a linear-Gaussian walker cannot foresee.
//
//   e_t = W (x_t - A [x_{t-1}, ..., x_{t-order}] - B [c_t, c_{t-1}] - b)
//
// A, B, b are fitted by ridge regression, W whitens the innovation (eigenvalues floored).
#pragma once

#include <cstdint>

#include "nn/torch.h"

namespace marey::moglow {

class LinearBase : public torch::nn::Module {
 public:
  LinearBase(int64_t poseDim, int64_t controlDim, int64_t order);

  /// Fits on rows of standardised data: targets [N, D], pasts [N, order * D] (newest first),
  /// controls [N, 2 * C] (current first). Accumulated in float64.
  /// Returns the mean log-density of the linear-Gaussian model on these rows, in nats.
  double fit(const torch::Tensor& targets, const torch::Tensor& pasts,
             const torch::Tensor& controls, double ridge, double floor);

  /// history [B, T, tau * D] oldest first, controlWindow [B, T, (tau + 1 + lookahead) * C]:
  /// the predicted pose [B, T, D].
  torch::Tensor predict(const torch::Tensor& history, const torch::Tensor& controlWindow,
                        int64_t tau) const;
  torch::Tensor toInnovation(const torch::Tensor& residual) const {
    return residual.matmul(whiten.t());
  }
  torch::Tensor toResidual(const torch::Tensor& innovation) const {
    return innovation.matmul(unwhiten.t());
  }
  const torch::Tensor& logDet() const { return logDetValue; }

  torch::Tensor poseWeight, controlWeight, bias;  ///< [D, order D], [D, 2 C], [D]
  torch::Tensor whiten, unwhiten, logDetValue;    ///< [D, D], [D, D], []

 private:
  int64_t m_poseDim, m_controlDim, m_order;
};

}  // namespace marey::moglow

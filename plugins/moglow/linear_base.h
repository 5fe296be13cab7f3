// The linear autoregressive base:
//
//   e_t = W (x_t - A [x_{t-1}, ..., x_{t-order}] - B [c_t, c_{t-1}] - b)
//
// A, B, b are fitted by ridge regression, W whitens the innovation: its covariance plus that of the
// observation noise, so that no direction is narrower than that; without noise, with a floor
// relative to the widest direction. The
// nets see the PCA-whitened history, with frame dropout, and the control.
#pragma once

#include <cstdint>

#include "moglow/pose_base.h"

namespace marey::moglow {

class LinearBase : public PoseBase {
 public:
  explicit LinearBase(const Config& config);
  Foresight foresee(const BaseInput& input) const override;
  Innovation toInnovation(const torch::Tensor& pose, const Foresight& foresight) const override;
  torch::Tensor toPose(const torch::Tensor& innovation, const Foresight& foresight) const override;
  void fit(const torch::Tensor& poses, const BaseInput& input, const torch::Tensor& noise) override;

 private:
  /// [N, order * D + 2 C]: newest pose first, then the present and the last control.
  torch::Tensor regressors(const BaseInput& input) const;

  int64_t m_poseDim, m_controlDim, m_tau, m_order;
  double m_ridge, m_floor;
  torch::Tensor m_weight, m_bias;                ///< [D, order D + 2 C], [D]
  torch::Tensor m_whiten, m_unwhiten;            ///< [D, D]
  torch::Tensor m_logDet;                        ///< []
  torch::Tensor m_historyMean, m_historyWhiten;  ///< [D], [D, D]
};

}  // namespace marey::moglow

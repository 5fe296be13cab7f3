#include "moglow/linear_base.h"

#include <cmath>

#include "nn/flow.h"

namespace marey::moglow {

LinearBase::LinearBase(int64_t poseDim, int64_t controlDim, int64_t order)
    : m_poseDim(poseDim), m_controlDim(controlDim), m_order(order) {
  poseWeight = register_buffer("pose_weight", torch::zeros({poseDim, order * poseDim}));
  controlWeight = register_buffer("control_weight", torch::zeros({poseDim, 2 * controlDim}));
  bias = register_buffer("bias", torch::zeros({poseDim}));
  whiten = register_buffer("whiten", torch::eye(poseDim));
  unwhiten = register_buffer("unwhiten", torch::eye(poseDim));
  logDetValue = register_buffer("log_det", torch::zeros({}));
}

double LinearBase::fit(const torch::Tensor& targets, const torch::Tensor& pasts,
                       const torch::Tensor& controls, double ridge, double floor) {
  const torch::NoGradGuard guard;
  const auto n = targets.size(0);
  const auto inputs =
      torch::cat({pasts, controls, torch::ones({n, 1}, pasts.options())}, 1).to(torch::kFloat64);
  const auto y = targets.to(torch::kFloat64);
  const auto gram = inputs.t().matmul(inputs) / n;
  // The intercept is not penalised.
  const auto penalty =
      torch::full({inputs.size(1)}, ridge * gram.diagonal().mean().item<double>(), torch::kFloat64);
  penalty[-1] = 0.0;
  const auto solution =
      torch::linalg_solve(gram + torch::diag(penalty), inputs.t().matmul(y) / n).t();
  const auto residual = y - inputs.matmul(solution.t());
  const auto w = nn::whitening(residual.t().matmul(residual) / n, floor);

  poseWeight.copy_(solution.narrow(1, 0, m_order * m_poseDim));
  controlWeight.copy_(solution.narrow(1, m_order * m_poseDim, 2 * m_controlDim));
  bias.copy_(solution.select(1, -1));
  whiten.copy_(w);
  unwhiten.copy_(torch::linalg_inv(w));
  logDetValue.copy_(std::get<1>(torch::linalg_slogdet(w)));
  const auto density = nn::baseLogDensity(residual.matmul(w.t()), 0.0);
  return density.mean().item<double>() + std::get<1>(torch::linalg_slogdet(w)).item<double>();
}

torch::Tensor LinearBase::predict(const torch::Tensor& history, const torch::Tensor& controlWindow,
                                  int64_t tau) const {
  std::vector<torch::Tensor> pasts, controls;
  for (int64_t lag = 1; lag <= m_order; ++lag)
    pasts.push_back(history.narrow(-1, (tau - lag) * m_poseDim, m_poseDim));
  for (int64_t lag = 0; lag <= 1; ++lag)
    controls.push_back(controlWindow.narrow(-1, (tau - lag) * m_controlDim, m_controlDim));
  return torch::cat(pasts, -1).matmul(poseWeight.t()) +
         torch::cat(controls, -1).matmul(controlWeight.t()) + bias;
}

}  // namespace marey::moglow

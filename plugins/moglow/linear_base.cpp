#include "moglow/linear_base.h"

#include "nn/flow/flow.h"

namespace marey::moglow {

LinearBase::LinearBase(const Config& c)
    : m_poseDim(c.poseDim),
      m_controlDim(c.controlDim),
      m_tau(c.tau),
      m_order(c.baseOrder),
      m_ridge(c.baseRidge),
      m_floor(c.baseFloor) {
  m_weight =
      register_buffer("weight", torch::zeros({m_poseDim, m_order * m_poseDim + 2 * m_controlDim}));
  m_bias = register_buffer("bias", torch::zeros({m_poseDim}));
  m_whiten = register_buffer("whiten", torch::eye(m_poseDim));
  m_unwhiten = register_buffer("unwhiten", torch::eye(m_poseDim));
  m_logDet = register_buffer("log_det", torch::zeros({}));
  m_historyMean = register_buffer("history_mean", torch::zeros({m_poseDim}));
  m_historyWhiten = register_buffer("history_whiten", torch::eye(m_poseDim));
}

torch::Tensor LinearBase::regressors(const BaseInput& input) const {
  std::vector<torch::Tensor> parts;
  for (int64_t lag = 1; lag <= m_order; ++lag)
    parts.push_back(input.history.narrow(-1, (m_tau - lag) * m_poseDim, m_poseDim));
  for (int64_t lag = 0; lag <= 1; ++lag)
    parts.push_back(input.control.narrow(-1, (m_tau - lag) * m_controlDim, m_controlDim));
  return torch::cat(parts, -1);
}

Foresight LinearBase::foresee(const BaseInput& input) const {
  auto history = input.history.view({-1, m_tau, m_poseDim});
  history = (history - m_historyMean).matmul(m_historyWhiten.t());
  if (input.keep.defined()) history = history * input.keep.unsqueeze(-1);
  return {.features = torch::cat({history.flatten(1), input.control}, -1),
          .parts = {regressors(input).matmul(m_weight.t()) + m_bias}};
}

PoseBase::Innovation LinearBase::toInnovation(const torch::Tensor& pose, const Foresight& f) const {
  return {(pose - f.parts[0]).matmul(m_whiten.t()), m_logDet.expand({pose.size(0)})};
}

torch::Tensor LinearBase::toPose(const torch::Tensor& innovation, const Foresight& f) const {
  return innovation.matmul(m_unwhiten.t()) + f.parts[0];
}

void LinearBase::fit(const torch::Tensor& poses, const BaseInput& input,
                     const torch::Tensor& noise) {
  const torch::NoGradGuard guard;
  const auto n = poses.size(0);
  const auto y = poses.to(torch::kFloat64),
             last =
                 input.history.narrow(-1, (m_tau - 1) * m_poseDim, m_poseDim).to(torch::kFloat64);
  auto x = regressors(input).to(torch::kFloat64);
  const auto xMean = x.mean(0), yMean = y.mean(0);
  x = x - xMean;
  const auto gram = x.t().matmul(x) / n;
  const auto penalty = m_ridge * gram.diagonal().mean() * torch::eye(x.size(1), gram.options());
  const auto weight = torch::linalg_solve(gram + penalty, x.t().matmul(y - yMean) / n).t();
  const auto residual = y - yMean - x.matmul(weight.t());
  const auto covariance = residual.t().matmul(residual) / n;
  const auto w = noise.defined()
                     ? nn::whitening(covariance + noise.to(torch::kFloat64).square().diag(), 0.0)
                     : nn::whitening(covariance, m_floor);
  m_weight.copy_(weight);
  m_bias.copy_(yMean - weight.matmul(xMean));
  m_whiten.copy_(w);
  m_unwhiten.copy_(torch::linalg_inv(w));
  m_logDet.copy_(std::get<1>(torch::linalg_slogdet(w)));
  const auto mean = last.mean(0), centred = last - mean;
  m_historyMean.copy_(mean);
  m_historyWhiten.copy_(nn::whitening(centred.t().matmul(centred) / n, 1e-4));
}

}  // namespace marey::moglow

#include "moglow/kinematic_regressions.h"

#include <algorithm>
#include <numeric>

#include "moglow/clusters.h"

namespace marey::moglow {
namespace {

constexpr int64_t kChunk = 32768;       ///< rows at a time: bounds the memory
constexpr double kPriorFrames = 200.0;  ///< weight of the common covariance in a regime's

/// Rows of `value` times the matrix of each row's regime (matrices [K, R, C]).
torch::Tensor byRegime(const torch::Tensor& value, const torch::Tensor& matrices,
                       const torch::Tensor& regime) {
  if (value.size(0) <= 64)
    return torch::bmm(value.unsqueeze(1), matrices.index_select(0, regime)).squeeze(1);
  auto out = torch::empty({value.size(0), matrices.size(2)}, value.options());
  const auto present = std::get<0>(torch::_unique(regime.to(torch::kCPU)));
  for (int64_t i = 0; i < present.size(0); ++i) {
    const int64_t k = present[i].item<int64_t>();
    const auto rows = regime.eq(k).nonzero().squeeze(1);
    out.index_copy_(0, rows, value.index_select(0, rows).matmul(matrices[k]));
  }
  return out;
}

/// The pose's coordinates with the first two of every foot in front.
torch::Tensor feetFirst(const std::vector<int64_t>& feet, int64_t poseDim) {
  std::vector<int64_t> order, rest(static_cast<size_t>(poseDim));
  std::iota(rest.begin(), rest.end(), 0);
  for (const int64_t foot : feet)
    for (int64_t i = 3 * foot; i < 3 * foot + 2; ++i) {
      order.push_back(i);
      std::erase(rest, i);
    }
  order.insert(order.end(), rest.begin(), rest.end());
  return torch::tensor(order, torch::kInt64);
}

}  // namespace

StepRegression::StepRegression(const Config& c, const BufferMaker& buffer) : m_ridge(c.baseRidge) {
  const int64_t d = c.poseDim, plain = d * c.baseOrder + 3 * c.baseOrder;
  m_mean = buffer("foreseen_mean", torch::zeros({plain}));
  m_weight = buffer("foreseen_weight", torch::zeros({plain, d}));
  m_bias = buffer("foreseen_bias", torch::zeros({d}));
}

torch::Tensor StepRegression::foreseen(const KinematicBody& body, const Past& past) const {
  const auto step = (regressors(body, past) - m_mean).matmul(m_weight) + m_bias;
  return past.poses.select(1, 0) + step.view({step.size(0), -1, 3});
}

void StepRegression::fit(const KinematicBody& body, const torch::Tensor& pose, const Past& past) {
  const auto target = (pose / past.size.unsqueeze(-1) - past.poses.select(1, 0)).flatten(1);
  const auto features = regressors(body, past);
  const auto mean = features.to(torch::kFloat64).mean(0),
             targetMean = target.to(torch::kFloat64).mean(0);
  const auto width = features.size(1);
  auto gram = torch::zeros({width, width}, mean.options());
  auto cross = torch::zeros({width, target.size(1)}, mean.options());
  for (int64_t at = 0; at < features.size(0); at += kChunk) {
    const int64_t n = std::min(kChunk, features.size(0) - at);
    const auto x = features.narrow(0, at, n).to(torch::kFloat64) - mean;
    gram += x.t().matmul(x);
    cross += x.t().matmul(target.narrow(0, at, n).to(torch::kFloat64) - targetMean);
  }
  const double ridge = m_ridge * static_cast<double>(features.size(0));
  m_weight.copy_(torch::linalg_solve(gram + ridge * torch::eye(width, gram.options()), cross));
  m_mean.copy_(mean);
  m_bias.copy_(targetMean);
}

RegimeRegressions::RegimeRegressions(const Config& c, const KinematicBody& body, int64_t rich,
                                     const BufferMaker& buffer)
    : m_regimes(c.regimes),
      m_gated(2 * static_cast<int64_t>(body.feet().size())),
      m_ridge(c.baseRidge),
      m_shrinkage(c.regimeShrinkage),
      m_floor(c.baseFloor),
      m_order(feetFirst(body.feet(), c.poseDim)),
      m_orderBack(m_order.argsort()) {
  const int64_t d = c.poseDim;
  m_centres = buffer("regime_centres", torch::zeros({m_regimes, regimeFeatureCount(body)}));
  m_mean = buffer("rich_mean", torch::zeros({rich}));
  m_weight = buffer("rich_weight", torch::zeros({m_regimes, rich + 1, d}));
  m_factor = buffer("factor", torch::eye(d).repeat({m_regimes, 1, 1}));
  m_factorInverse = buffer("factor_inverse", torch::eye(d).repeat({m_regimes, 1, 1}));
  m_factorLogDet = buffer("factor_log_det", torch::zeros({m_regimes}));
}

torch::Tensor RegimeRegressions::regimeOf(const KinematicBody& body, const Past& past) const {
  return nearest(regimeFeatures(body, past), m_centres);
}

torch::Tensor RegimeRegressions::predicted(const Past& past, const torch::Tensor& rich,
                                           const torch::Tensor& regime) const {
  const auto ones = torch::ones({rich.size(0), 1}, rich.options());
  return byRegime(torch::cat({rich - m_mean, ones}, 1), m_weight, regime) * past.size;
}

RegimeRegressions::Whitened RegimeRegressions::whitened(const torch::Tensor& residual,
                                                        const torch::Tensor& regime) const {
  const auto ordered = residual.index_select(1, m_order.to(residual.device()));
  return {byRegime(ordered, m_factorInverse.transpose(1, 2), regime),
          m_factorLogDet.index_select(0, regime)};
}

torch::Tensor RegimeRegressions::residual(const torch::Tensor& innovation,
                                          const torch::Tensor& regime) const {
  return byRegime(innovation, m_factor.transpose(1, 2), regime)
      .index_select(1, m_orderBack.to(innovation.device()));
}

void RegimeRegressions::fit(const KinematicBody& body, const torch::Tensor& local,
                            const Past& past) {
  const auto target = local / past.size;
  const auto rich = richRegressors(body, past);
  const auto keys = regimeFeatures(body, past);
  m_centres.copy_(clusterCentres(keys, m_regimes));
  m_mean.copy_(rich.to(torch::kFloat64).mean(0));
  const auto regime = regimeOf(body, past);
  const auto total = static_cast<double>(rich.size(0));
  const int64_t width = rich.size(1) + 1, d = local.size(1);
  auto grams = torch::zeros({m_regimes, width, width}, torch::kFloat64);
  auto crosses = torch::zeros({m_regimes, width, d}, torch::kFloat64);
  for (int64_t k = 0; k < m_regimes; ++k) {
    const auto rows = regime.eq(k).nonzero().squeeze(1);
    for (int64_t at = 0; at < rows.size(0); at += kChunk) {
      const auto part = rows.narrow(0, at, std::min(kChunk, rows.size(0) - at));
      const auto centred = rich.index_select(0, part) - m_mean;
      const auto x = torch::cat({centred, torch::ones({part.size(0), 1}, centred.options())}, 1)
                         .to(torch::kFloat64);
      grams[k] += x.t().matmul(x).cpu();
      crosses[k] += x.t().matmul(target.index_select(0, part).to(torch::kFloat64)).cpu();
    }
  }
  const auto diagonal = [&](double strength, double intercept) {
    auto out = torch::full({width}, strength, torch::kFloat64);
    out[-1] = intercept;
    return torch::diag(out);
  };
  const auto common =
      torch::linalg_solve(grams.sum(0) + diagonal(m_ridge * total, 1e-6), crosses.sum(0));
  // A regime corrects the common regression by what its own frames say, shrunk.
  const auto shrink = diagonal(m_shrinkage * total, 10.0);
  auto weight = torch::empty({m_regimes, width, d}, torch::kFloat64);
  for (int64_t k = 0; k < m_regimes; ++k)
    weight[k] =
        common + torch::linalg_solve(grams[k] + shrink, crosses[k] - grams[k].matmul(common));
  m_weight.copy_(weight);
}

/// Of a covariance whose first values stay as they are: a triangle by blocks.
torch::Tensor RegimeRegressions::conditionalFactor(const torch::Tensor& covariance) const {
  const int64_t gated = m_gated, rest = covariance.size(0) - gated;
  const auto cross = covariance.narrow(0, gated, rest).narrow(1, 0, gated);
  const auto slope =
      torch::linalg_solve(covariance.narrow(0, 0, gated).narrow(1, 0, gated), cross.t()).t();
  const auto left =
      covariance.narrow(0, gated, rest).narrow(1, gated, rest) - slope.matmul(cross.t());
  const auto [values, vectors] = torch::linalg_eigh(0.5 * (left + left.t()));
  const auto floored = values.clamp_min(std::max(m_floor * values.max().item<double>(), 1e-8));
  auto factor = torch::eye(gated + rest, covariance.options());
  factor.narrow(0, gated, rest).narrow(1, 0, gated).copy_(slope);
  factor.narrow(0, gated, rest)
      .narrow(1, gated, rest)
      .copy_(torch::linalg_cholesky(vectors.matmul(torch::diag(floored)).matmul(vectors.t())));
  return factor;
}

void RegimeRegressions::fitWhitening(const torch::Tensor& residual, const torch::Tensor& regime) {
  const auto ordered = residual.index_select(1, m_order.to(residual.device())).to(torch::kFloat64);
  const auto centred = ordered - ordered.mean(0);
  const auto common = centred.t().matmul(centred) / static_cast<double>(ordered.size(0));
  for (int64_t k = 0; k < m_regimes; ++k) {
    const auto rows = ordered.index_select(0, regime.eq(k).nonzero().squeeze(1));
    const auto factor = conditionalFactor((rows.t().matmul(rows) + kPriorFrames * common) /
                                          (static_cast<double>(rows.size(0)) + kPriorFrames));
    m_factor[k].copy_(factor);
    m_factorInverse[k].copy_(torch::linalg_inv(factor));
    m_factorLogDet[k] = -factor.diagonal().log().sum();
  }
}

}  // namespace marey::moglow

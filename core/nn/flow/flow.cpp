#include "nn/flow/flow.h"

#include <cmath>
#include <utility>

#include "base/error.h"

namespace marey::nn {
namespace {

/// log-determinant of a layer that acts alike on every frame, spread to [B, T].
torch::Tensor perFrame(const torch::Tensor& scalar, const torch::Tensor& x) {
  return scalar.expand({x.size(0), x.size(1)});
}

}  // namespace

// ---- ActNorm

ActNorm::ActNorm(int64_t channels) {
  bias = register_parameter("bias", torch::zeros({channels}));
  logs = register_parameter("logs", torch::zeros({channels}));
}

Transformed ActNorm::toLatent(const torch::Tensor& x) const {
  return {(x + bias) * logs.exp(), perFrame(logs.sum(), x)};
}

torch::Tensor ActNorm::toData(const torch::Tensor& z) const {
  return z * (-logs).exp() - bias;
}

void ActNorm::initialise(const torch::Tensor& frames, double constant) {
  const torch::NoGradGuard guard;
  bias.copy_(-frames.mean(0));
  const auto deviation = frames.std(0, /*unbiased=*/false);
  logs.copy_(torch::where(deviation < constant, 0.0, -deviation.clamp_min(constant).log()));
}

// ---- InvertibleLinear

InvertibleLinear::InvertibleLinear(int64_t channels, bool lu, at::Generator& generator) : m_lu(lu) {
  const auto square = torch::zeros({channels, channels});
  if (m_lu) {
    permutation = register_buffer("permutation", square.clone());
    signS = register_buffer("sign_s", torch::zeros({channels}));
    lower = register_parameter("lower", square.clone());
    logS = register_parameter("log_s", torch::zeros({channels}));
    upper = register_parameter("upper", square.clone());
  } else {
    free = register_parameter("weight", square.clone());
  }
  // A random rotation: the usual start of Glow.
  const auto gaussian = torch::randn({channels, channels}, generator, torch::kFloat64);
  assign(std::get<0>(torch::linalg_qr(gaussian)));
}

void InvertibleLinear::assign(const torch::Tensor& matrix) {
  const torch::NoGradGuard guard;
  if (!m_lu) {
    free.copy_(matrix);
    return;
  }
  const auto [p, l, u] = torch::linalg_lu(matrix.to(torch::kFloat64));
  const auto diagonal = u.diagonal();
  if (!diagonal.abs().gt(1e-12).all().item<bool>())
    throw NumericError("invertible linear layer: the matrix is singular");
  permutation.copy_(p);
  lower.copy_(l.tril(-1));
  upper.copy_(u.triu(1));
  logS.copy_(diagonal.abs().log());
  signS.copy_(diagonal.sign());
}

torch::Tensor InvertibleLinear::weight() const {
  if (!m_lu) return free;
  const auto l = lower.tril(-1) + torch::eye(lower.size(0), lower.options());
  const auto u = upper.triu(1) + torch::diag(signS * logS.exp());
  return permutation.matmul(l.matmul(u));
}

torch::Tensor InvertibleLinear::logDet() const {
  return m_lu ? logS.sum() : std::get<1>(torch::linalg_slogdet(free));
}

Transformed InvertibleLinear::toLatent(const torch::Tensor& x) const {
  return {torch::matmul(x, weight().t()), perFrame(logDet(), x)};
}

torch::Tensor InvertibleLinear::toData(const torch::Tensor& z) const {
  if (!m_lu) return torch::matmul(z, torch::linalg_inv(free).t());
  // Two triangular solves lose less than one general inverse.
  const auto columns = z.reshape({-1, z.size(-1)}).t();
  const auto l = lower.tril(-1) + torch::eye(lower.size(0), lower.options());
  const auto u = upper.triu(1) + torch::diag(signS * logS.exp());
  const auto y = torch::linalg_solve_triangular(l, permutation.t().matmul(columns), /*upper=*/false,
                                                /*left=*/true, /*unitriangular=*/true);
  const auto x = torch::linalg_solve_triangular(u, y, /*upper=*/true);
  return x.t().reshape(z.sizes()).contiguous();
}

// ---- AffineCoupling

AffineCoupling::AffineCoupling(int64_t channels, int64_t conditioning, const CouplingNetSpec& spec,
                               at::Generator& generator)
    : m_passed(channels / 2) {
  m_net = register_module(
      "net", std::make_shared<CouplingNet>(m_passed + conditioning, 2 * (channels - m_passed), spec,
                                           generator));
}

AffineCoupling::ShiftScale AffineCoupling::shiftScale(const torch::Tensor& passed,
                                                      const torch::Tensor& conditioning,
                                                      RecurrentState& state) const {
  const auto out = m_net->forward(torch::cat({passed, conditioning}, -1), state);
  const auto pairs = out.unflatten(-1, at::IntArrayRef{out.size(-1) / 2, 2});
  return {pairs.select(-1, 0), torch::sigmoid(pairs.select(-1, 1) + 2.0) + 1e-6};
}

Transformed AffineCoupling::toLatent(const torch::Tensor& x, const torch::Tensor& conditioning,
                                     RecurrentState& state) const {
  const auto z1 = x.narrow(-1, 0, m_passed);
  const auto z2 = x.narrow(-1, m_passed, x.size(-1) - m_passed);
  const auto [shift, scale] = shiftScale(z1, conditioning, state);
  return {torch::cat({z1, (z2 + shift) * scale}, -1), scale.log().sum(-1)};
}

torch::Tensor AffineCoupling::toData(const torch::Tensor& z, const torch::Tensor& conditioning,
                                     RecurrentState& state) const {
  const auto z1 = z.narrow(-1, 0, m_passed);
  const auto z2 = z.narrow(-1, m_passed, z.size(-1) - m_passed);
  const auto [shift, scale] = shiftScale(z1, conditioning, state);
  return torch::cat({z1, z2 / scale - shift}, -1);
}

// ---- Flow

Flow::Flow(const FlowSpec& spec, at::Generator& generator) : m_spec(spec) {
  for (int64_t k = 0; k < spec.steps; ++k) {
    const std::string prefix = "step" + std::to_string(k) + "_";
    m_steps.push_back(
        {register_module(prefix + "actnorm", std::make_shared<ActNorm>(spec.channels)),
         register_module(prefix + "linear",
                         std::make_shared<InvertibleLinear>(spec.channels, spec.lu, generator)),
         register_module(prefix + "coupling",
                         std::make_shared<AffineCoupling>(spec.channels, spec.conditioning,
                                                          spec.net, generator))});
  }
}

Transformed Flow::toLatent(const torch::Tensor& x, const torch::Tensor& conditioning,
                           FlowState& state) const {
  state.resize(m_steps.size());
  Transformed out{x, torch::zeros({x.size(0), x.size(1)}, x.options())};
  for (size_t k = 0; k < m_steps.size(); ++k) {
    const auto normed = m_steps[k].actnorm->toLatent(out.value);
    const auto mixed = m_steps[k].linear->toLatent(normed.value);
    const auto coupled = m_steps[k].coupling->toLatent(mixed.value, conditioning, state[k]);
    out = {coupled.value, out.logDet + normed.logDet + mixed.logDet + coupled.logDet};
  }
  return out;
}

torch::Tensor Flow::toData(const torch::Tensor& z, const torch::Tensor& conditioning,
                           FlowState& state) const {
  state.resize(m_steps.size());
  torch::Tensor x = z;
  for (size_t k = m_steps.size(); k-- > 0;) {
    x = m_steps[k].coupling->toData(x, conditioning, state[k]);
    x = m_steps[k].actnorm->toData(m_steps[k].linear->toData(x));
  }
  return x;
}

void Flow::initialise(const torch::Tensor& x, const torch::Tensor& conditioning, Start start) {
  const torch::NoGradGuard guard;
  torch::Tensor value = x;
  for (size_t k = 0; k < m_steps.size(); ++k) {
    const Step& step = m_steps[k];
    if (start == Start::Reversal) step.linear->assign(torch::eye(m_spec.channels).flip(0));
    if (k == 0 && start == Start::Whitening) {
      const auto frames = value.flatten(0, 1).to(torch::kFloat64);
      const auto centred = frames - frames.mean(0);
      step.actnorm->bias.copy_(-frames.mean(0));
      step.linear->assign(whitening(centred.t().matmul(centred) / centred.size(0), 1e-6));
    } else {
      step.actnorm->initialise(value.flatten(0, 1));
    }
    RecurrentState fresh;
    const auto mixed = step.linear->toLatent(step.actnorm->toLatent(value).value).value;
    value = step.coupling->toLatent(mixed, conditioning, fresh).value;
  }
}

// ---- free functions

torch::Tensor baseLogDensity(const torch::Tensor& z, double df) {
  const auto d = static_cast<double>(z.size(-1));
  const auto squared = z.square().sum(-1);
  if (df <= 0.0) return -0.5 * (squared + d * std::log(2.0 * M_PI));
  const double constant =
      std::lgamma(0.5 * (df + d)) - std::lgamma(0.5 * df) - 0.5 * d * std::log(df * M_PI);
  return constant - 0.5 * (df + d) * torch::log1p(squared / df);
}

torch::Tensor whitening(const torch::Tensor& covariance, double floor) {
  const auto [values, vectors] = torch::linalg_eigh(covariance.to(torch::kFloat64));
  const auto floored = values.clamp_min(values.max().item<double>() * floor + 1e-300);
  return torch::diag(floored.rsqrt()).matmul(vectors.t());
}

}  // namespace marey::nn

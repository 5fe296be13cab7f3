#include "model/gradient/gradient_step.h"

#include <algorithm>
#include <cmath>

namespace marey {
namespace {

double normOf(const std::vector<torch::Tensor>& tensors) {
  std::vector<torch::Tensor> norms;
  for (const auto& t : tensors) norms.push_back(t.norm());
  return norms.empty() ? 0.0 : torch::stack(norms).to(torch::kFloat64).norm().item<double>();
}

}  // namespace

GradientStep::GradientStep(TrainableModel& net, const TrainingConfig& config,
                           nn::ProcessGroup& group)
    : m_optimiser(makeOptimiser(config, net, net.execution)),
      m_net(net),
      m_config(config),
      m_group(group) {}

std::vector<double> GradientStep::gradientsOf(const TrainingBatch& batch) {
  const double weight = std::max(1.0, m_net.weight(batch));
  const int64_t windows = batch.pose.size(0), parts = int64_t{m_config.accumulate},
                rank = m_group.rank().rank, size = m_group.rank().size;
  std::vector<double> losses(1 + m_net.objective().terms.size(), 0.0);
  for (auto& p : m_net.parameters()) p.mutable_grad() = torch::Tensor();
  for (int64_t part = rank * parts; part < (rank + 1) * parts; ++part) {
    const int64_t first = windows * part / (size * parts),
                  count = windows * (part + 1) / (size * parts) - first;
    if (count == 0) continue;
    // A share of the mean over the whole batch.
    const Loss loss = m_net.loss(batch.narrow(first, count));
    const auto share = loss.sum / weight;
    const double value = share.item<double>();
    losses[0] += value;
    for (size_t i = 0; i < loss.terms.size(); ++i)
      losses.at(i + 1) += loss.terms[i].second.item<double>() / weight;
    if (std::isfinite(value)) share.backward();
  }
  return losses;
}

void GradientStep::sumOverProcesses(std::vector<double>& losses) {
  if (m_group.rank().size == 1) return;
  const torch::NoGradGuard guard;
  std::vector<torch::Tensor> parts;
  auto parameters = m_net.parameters();
  for (const auto& p : parameters)
    parts.push_back((p.grad().defined() ? p.grad() : torch::zeros_like(p)).flatten());
  parts.push_back(torch::tensor(losses, torch::kFloat64).to(parts.front().options()));
  auto flat = torch::cat(parts);
  m_group.sum(flat);
  int64_t at = 0;
  for (auto& p : parameters) {
    p.mutable_grad() = flat.narrow(0, at, p.numel()).view_as(p);
    at += p.numel();
  }
  for (double& loss : losses) loss = flat[at++].item<double>();
}

double GradientStep::clip(GradientClip& out) const {
  const torch::NoGradGuard guard;
  std::vector<torch::Tensor> gradients;
  for (const auto& p : m_net.parameters())
    if (p.grad().defined()) gradients.push_back(p.grad());
  const double raw = normOf(gradients);
  double norm = raw;
  // No value of a gradient is above its norm.
  if (m_config.clipValue > 0 && raw > m_config.clipValue) {
    out.limit = m_config.clipValue;
    for (auto& g : gradients) g = g.clamp(-out.limit, out.limit);
    norm = normOf(gradients);
  }
  if (m_config.clipNorm > 0 && norm > m_config.clipNorm) out.scale = m_config.clipNorm / norm;
  return raw;
}

StepReport GradientStep::take(const TrainingBatch& batch, double rate, int64_t count) {
  StepReport out;
  std::vector<double> losses = gradientsOf(batch);
  sumOverProcesses(losses);
  out.loss = losses.front();
  out.terms.assign(losses.begin() + 1, losses.end());
  GradientClip limits;
  out.norm = std::isfinite(out.loss) ? clip(limits) : out.loss;
  out.taken = std::isfinite(out.loss) && std::isfinite(out.norm);
  if (out.taken) m_optimiser->step(rate, count, limits);
  return out;
}

}  // namespace marey

#include "moglow/net.h"

#include <ATen/CPUGeneratorImpl.h>

namespace marey::moglow {
namespace {

/// Frames that data-dependent starts look at: enough for stable covariances, small in memory.
constexpr int64_t kActnormFrames = 4096;

nn::FlowSpec flowSpec(const Config& c) {
  return {.channels = c.poseDim,
          .conditioning = c.conditioning(),
          .steps = c.steps,
          .lu = c.lu,
          .net = {.cell = c.cell, .hidden = c.hidden, .layers = c.layers}};
}

/// Sliding windows of `width` rows: [B, N, F] -> [B, N - width + 1, width * F], oldest first.
torch::Tensor slidingWindows(const torch::Tensor& rows, int64_t width) {
  return rows.unfold(1, width, 1).transpose(2, 3).flatten(2);
}

}  // namespace

Net::Net(const Config& config, uint64_t seed) : m_config(config) {
  auto generator = at::detail::createCPUGenerator(seed);
  m_flow = register_module("flow", std::make_shared<nn::Flow>(flowSpec(config), generator));
  if (config.poseBase == "none") return;
  m_base = register_module(
      "base", std::make_shared<LinearBase>(config.poseDim, config.controlDim, config.baseOrder));
  m_historyMean = register_buffer("history_mean", torch::zeros({config.poseDim}));
  m_historyWhiten = register_buffer("history_whiten", torch::eye(config.poseDim));
}

Net::Context Net::contextOf(const torch::Tensor& poses, const torch::Tensor& controls) const {
  const int64_t past = poses.size(1) - 1;
  return {slidingWindows(poses.narrow(1, 0, past), m_config.tau),
          slidingWindows(controls, m_config.tau + 1 + m_config.lookahead)};
}

torch::Tensor Net::conditioning(const Context& context, const torch::Tensor& keep) const {
  torch::Tensor history = context.history;
  if (m_base || keep.defined()) {
    history = history.unflatten(-1, at::IntArrayRef{m_config.tau, m_config.poseDim});
    if (m_base) history = (history - m_historyMean).matmul(m_historyWhiten.t());
    if (keep.defined()) history = history * keep.unsqueeze(-1);
    history = history.flatten(-2);
  }
  return torch::cat({history, context.control}, -1);
}

nn::Transformed Net::toLatent(const torch::Tensor& x, const Context& context,
                              const torch::Tensor& keep, nn::FlowState& state) const {
  const auto seen = conditioning(context, keep);
  if (!m_base) return m_flow->toLatent(x, seen, state);
  const auto e =
      m_base->toInnovation(x - m_base->predict(context.history, context.control, m_config.tau));
  auto out = m_flow->toLatent(e, seen, state);
  out.logDet = out.logDet + m_base->logDet();
  return out;
}

torch::Tensor Net::toData(const torch::Tensor& z, const Context& context,
                          nn::FlowState& state) const {
  const auto x = m_flow->toData(z, conditioning(context, {}), state);
  if (!m_base) return x;
  return m_base->toResidual(x) + m_base->predict(context.history, context.control, m_config.tau);
}

torch::Tensor Net::logLikelihood(const TrainingBatch& batch, at::Generator* dropout) {
  const int64_t frames = batch.pose.size(1) - m_config.tau - m_config.lookahead;
  const auto poses = batch.pose.narrow(1, 0, m_config.tau + frames);
  torch::Tensor keep;
  if (dropout != nullptr && m_config.dropout > 0.0) {
    // Drawn on the CPU, so that a device changes no batch.
    const auto uniform = torch::rand({batch.pose.size(0), frames, m_config.tau}, *dropout);
    keep = uniform.ge(m_config.dropout).to(batch.pose.options());
  }
  nn::FlowState state;
  const auto latent =
      toLatent(poses.narrow(1, m_config.tau, frames), contextOf(poses, batch.control), keep, state);
  return nn::baseLogDensity(latent.value, m_config.degreesOfFreedom()) + latent.logDet;
}

Json Net::initialise(const TrainingFrames& frames) {
  const torch::NoGradGuard guard;
  Json facts = Json::object();
  const auto rows = [](const torch::Tensor& values, const torch::Tensor& index) {
    return values.index_select(0, index);
  };
  if (m_base) {
    std::vector<torch::Tensor> pasts;
    for (int64_t lag = 1; lag <= m_config.baseOrder; ++lag)
      pasts.push_back(rows(frames.pose, frames.usable - lag));
    const auto controls = torch::cat(
        {rows(frames.control, frames.usable), rows(frames.control, frames.usable - 1)}, 1);
    facts["linear_gaussian_train_nats_per_frame"] =
        m_base->fit(rows(frames.pose, frames.usable), torch::cat(pasts, 1), controls,
                    m_config.baseRidge, m_config.baseFloor);
    const auto mean = frames.pose.mean(0);
    const auto centred = (frames.pose - mean).to(torch::kFloat64);
    m_historyMean.copy_(mean);
    m_historyWhiten.copy_(nn::whitening(centred.t().matmul(centred) / centred.size(0), 1e-4));
  }
  // A fixed, even choice of frames, each as a sequence of one.
  const int64_t count = std::min<int64_t>(kActnormFrames, frames.usable.size(0));
  const auto chosen = frames.usable.index_select(
      0, (torch::arange(count, torch::kFloat64) * frames.usable.size(0) / count)
             .to(torch::kInt64)
             .to(frames.usable.device()));
  std::vector<torch::Tensor> pose, control;
  for (int64_t offset = -m_config.tau; offset <= m_config.lookahead; ++offset) {
    if (offset <= 0) pose.push_back(rows(frames.pose, chosen + offset));
    control.push_back(rows(frames.control, chosen + offset));
  }
  const auto context = contextOf(torch::stack(pose, 1), torch::stack(control, 1));
  auto x = rows(frames.pose, chosen).unsqueeze(1);
  if (m_base)
    x = m_base->toInnovation(x - m_base->predict(context.history, context.control, m_config.tau));
  m_flow->initialise(x, conditioning(context, {}), m_config.start == "whitening");
  return facts;
}

}  // namespace marey::moglow

#include "moglow/net.h"

#include <ATen/CPUGeneratorImpl.h>

#include "moglow/kinematic_base.h"
#include "moglow/linear_base.h"

namespace marey::moglow {
namespace {

/// Frames that data-dependent starts look at: enough for stable moments, small in memory.
constexpr int64_t kStartFrames = 4096;
constexpr uint64_t kNoiseSeed = 21;  ///< of the observation noise of those frames

nn::Flow::Start startOf(const std::string& name) {
  if (name == "whitening") return nn::Flow::Start::Whitening;
  return name == "reversal" ? nn::Flow::Start::Reversal : nn::Flow::Start::Orthogonal;
}

/// Sliding windows of `width` rows: [B, N, F] -> [B, N - width + 1, width * F], oldest first.
torch::Tensor slidingWindows(const torch::Tensor& rows, int64_t width) {
  return rows.unfold(1, width, 1).transpose(2, 3).flatten(2);
}

/// The base works frame by frame: [B, T, F] -> [B * T, F].
BaseInput flattened(const Net::Context& c) {
  return {c.history.flatten(0, 1), c.control.flatten(0, 1),
          c.keep.defined() ? c.keep.flatten(0, 1) : c.keep};
}

}  // namespace

std::shared_ptr<PoseBase> makePoseBase(const Config& config, const BodyFacts& body) {
  if (config.poseBase == "linear") return std::make_shared<LinearBase>(config);
  if (config.poseBase == "kinematic") return std::make_shared<KinematicBase>(config, body);
  return nullptr;
}

Net::Net(const Config& config, const BodyFacts& body, uint64_t seed) : m_config(config) {
  auto generator = at::detail::createCPUGenerator(seed);
  m_flow = register_module("flow", std::make_shared<nn::Flow>(config.flow(), generator));
  m_base = makePoseBase(config, body);
  if (m_base) register_module("base", m_base);
  if (config.hasMotionBase())
    m_motion = register_module("motion", makePoseBase(config.ofMotionBase(), body));
}

Net::Context Net::contextOf(const torch::Tensor& poses, const torch::Tensor& controls) const {
  return {slidingWindows(poses.narrow(1, 0, poses.size(1) - 1), m_config.tau),
          slidingWindows(controls, m_config.tau + 1 + m_config.lookahead),
          {}};
}

torch::Tensor Net::plainConditioning(const Context& context) const {
  if (!context.keep.defined()) return torch::cat({context.history, context.control}, -1);
  const auto frames =
      context.history.unflatten(-1, at::IntArrayRef{m_config.tau, m_config.poseDim});
  return torch::cat({(frames * context.keep.unsqueeze(-1)).flatten(-2), context.control}, -1);
}

nn::Transformed Net::toLatentBy(const FlowPass& pass, const torch::Tensor& x,
                                const Context& context) const {
  nn::FlowConditioning seen{.blockWidth = m_config.poseDim};
  // These nets see the history frame by frame, first of all.
  if (m_config.poseBase != "kinematic") seen.keep = context.keep;
  if (!m_base) {
    seen.values = plainConditioning(context);
    return pass(x, seen);
  }
  const int64_t batch = x.size(0), frames = x.size(1);
  const Foresight foresight = m_base->foresee(flattened(context));
  const auto e = m_base->toInnovation(x.flatten(0, 1), foresight);
  const auto innovation = e.value.view({batch, frames, -1});
  const auto [passed, rest] = split(innovation);
  seen.values = seenBy(foresight, passed);
  const auto out = pass(rest, seen);
  return {torch::cat({passed, out.value}, -1), out.logDet + e.logDet.view({batch, frames})};
}

nn::Transformed Net::toLatent(const torch::Tensor& x, const Context& context,
                              nn::FlowState& state) const {
  return toLatentBy(
      [&](const torch::Tensor& data, const nn::FlowConditioning& seen) {
        return m_flow->toLatent(data, seen.values, state);
      },
      x, context);
}

std::pair<torch::Tensor, torch::Tensor> Net::split(const torch::Tensor& innovation) const {
  const int64_t passed = m_config.passedChannels();
  return {innovation.narrow(-1, 0, passed),
          innovation.narrow(-1, passed, innovation.size(-1) - passed)};
}

torch::Tensor Net::seenBy(const Foresight& foresight, const torch::Tensor& passed) const {
  const auto features = foresight.features.view({passed.size(0), passed.size(1), -1});
  return m_config.feetPassFlow ? torch::cat({features, passed}, -1) : features;
}

torch::Tensor Net::toData(const torch::Tensor& z, const Context& context,
                          nn::FlowState& state) const {
  return toDataBy(m_base.get(), z, context, state);
}

torch::Tensor Net::toMotion(const torch::Tensor& z, const Context& context,
                            nn::FlowState& state) const {
  return toDataBy(m_motion ? m_motion.get() : m_base.get(), z, context, state);
}

torch::Tensor Net::toDataBy(const PoseBase* base, const torch::Tensor& z, const Context& context,
                            nn::FlowState& state) const {
  if (base == nullptr) return m_flow->toData(z, plainConditioning(context), state);
  const int64_t batch = z.size(0), frames = z.size(1);
  const Foresight foresight = base->foresee(flattened(context));
  const auto [passed, rest] = split(z);
  const auto e = torch::cat({passed, m_flow->toData(rest, seenBy(foresight, passed), state)}, -1);
  return base->toPose(e.flatten(0, 1), foresight).view({batch, frames, -1});
}

Objective Net::objective() const {
  return {.name = "negative log-likelihood", .unit = "nats per frame", .likelihood = true};
}

Loss Net::loss(const TrainingBatch& batch) {
  return {-(logLikelihood(batch) * scoredMask(batch)).sum()};
}

torch::Tensor Net::draw(const TrainingBatch& batch, at::Generator& generator) const {
  if (m_config.dropout <= 0.0) return {};
  const int64_t frames = batch.pose.size(1) - m_config.tau - m_config.lookahead;
  // Drawn on the CPU, so that a device changes no batch.
  const auto uniform = torch::rand({batch.pose.size(0), frames, m_config.tau}, generator);
  return uniform.ge(m_config.dropout).to(batch.pose.options());
}

torch::Tensor Net::logLikelihood(const TrainingBatch& batch) {
  const int64_t frames = batch.pose.size(1) - m_config.tau - m_config.lookahead;
  const auto poses = batch.pose.narrow(1, 0, m_config.tau + frames);
  Context context = contextOf(batch.seenPose().narrow(1, 0, m_config.tau + frames), batch.control);
  context.keep = batch.draws;
  const auto pass = [&](const torch::Tensor& x, const nn::FlowConditioning& seen) {
    if (execution == Execution::Engine && nn::takesFastPath(*m_flow, x, seen))
      return nn::fastToLatent(*m_flow, x, seen);
    nn::FlowState state;
    return m_flow->toLatent(x, seen.values, state);
  };
  auto observed = poses.narrow(1, m_config.tau, frames);
  // Only what is to be foreseen is noisy: the history is that of the motion.
  if (batch.noise.defined()) observed = observed + batch.noise.narrow(1, m_config.tau, frames);
  const auto latent = toLatentBy(pass, observed, context);
  return nn::baseLogDensity(latent.value, m_config.degreesOfFreedom()) + latent.logDet;
}

Net::Context Net::contextAt(const TrainingFrames& frames, const torch::Tensor& rows) const {
  std::vector<torch::Tensor> poses, controls;
  for (int64_t offset = -m_config.tau; offset <= m_config.lookahead; ++offset) {
    if (offset < 0) poses.push_back(frames.pose.index_select(0, rows + offset));
    controls.push_back(frames.control.index_select(0, rows + offset));
  }
  return {torch::cat(poses, 1).unsqueeze(1), torch::cat(controls, 1).unsqueeze(1), {}};
}

namespace {

/// A fixed, even choice of at most `most` usable frames.
torch::Tensor evenRows(const TrainingFrames& frames, int64_t most) {
  const int64_t all = frames.usable.size(0), count = std::min(most, all);
  return frames.usable.index_select(0, (torch::arange(count, torch::kFloat64) * all / count)
                                           .to(torch::kInt64)
                                           .to(frames.usable.device()));
}

/// Poses of some frames as they are observed.
torch::Tensor observedPoses(const TrainingFrames& frames, const torch::Tensor& rows) {
  const auto poses = frames.pose.index_select(0, rows);
  if (!frames.noise.defined()) return poses;
  auto generator = at::detail::createCPUGenerator(kNoiseSeed);
  return poses +
         frames.noise * torch::randn(poses.sizes(), generator, torch::kFloat32).to(poses.device());
}

}  // namespace

void Net::fitBases(const TrainingFrames& frames, Json& facts) {
  const auto input = flattened(contextAt(frames, frames.usable));
  const auto poses = frames.pose.index_select(0, frames.usable);
  m_base->fit(poses, input, frames.noise);
  if (m_motion) m_motion->fit(poses, input, {});
  const auto rows = evenRows(frames, 8 * kStartFrames);
  const auto foresight = m_base->foresee(flattened(contextAt(frames, rows)));
  const auto e = m_base->toInnovation(observedPoses(frames, rows), foresight);
  facts["base_nats_per_frame"] =
      (nn::baseLogDensity(e.value, 0.0) + e.logDet).mean().item<double>();
}

Json Net::initialise(const TrainingFrames& frames) {
  const torch::NoGradGuard guard;
  Json facts = Json::object();
  if (m_base) fitBases(frames, facts);
  // Each frame as a sequence of one.
  const auto rows = evenRows(frames, kStartFrames);
  const auto context = contextAt(frames, rows);
  const auto x = observedPoses(frames, rows);
  if (!m_base) {
    m_flow->initialise(x.unsqueeze(1), plainConditioning(context), startOf(m_config.start));
    return facts;
  }
  const Foresight foresight = m_base->foresee(flattened(context));
  const auto [passed, rest] = split(m_base->toInnovation(x, foresight).value.unsqueeze(1));
  m_flow->initialise(rest, seenBy(foresight, passed), startOf(m_config.start));
  return facts;
}

torch::Tensor Net::poseDerivatives(const TrainingFrames& frames, int64_t count) {
  const auto rows = evenRows(frames, count);
  const auto context = contextAt(frames, rows);
  auto generator = at::detail::createCPUGenerator(kNoiseSeed);
  auto z = torch::randn({rows.size(0), 1, m_config.poseDim}, generator, torch::kFloat32)
               .to(frames.pose.device())
               .requires_grad_(true);
  nn::FlowState state;
  const auto x = toData(z, context, state).squeeze(1);
  std::vector<torch::Tensor> out;
  for (int64_t d = 0; d < m_config.poseDim; ++d)
    out.push_back(torch::autograd::grad({x.select(1, d).sum()}, {z}, {}, true)[0].squeeze(1));
  return torch::stack(out, 1);
}

}  // namespace marey::moglow

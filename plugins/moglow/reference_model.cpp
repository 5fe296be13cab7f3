#include "moglow/reference_model.h"

#include <utility>

#include "base/error.h"
#include "model/gradient/weights.h"

namespace marey::moglow {
namespace {

/// What a RolloutState of this family holds. Tensors are never changed in place, so a copy of
/// the value is a fork.
struct Rollout {
  torch::Tensor history;  ///< [B, tau, D], standardised
  nn::FlowState flow;
};

Matrix toMatrix(const torch::Tensor& t) {
  const auto rows = t.to(torch::kFloat32).contiguous();
  return Eigen::Map<const Matrix>(rows.data_ptr<float>(), rows.size(0), rows.size(1));
}

torch::Tensor vectorOr(const std::vector<float>& values, int size, float fallback) {
  return values.empty() ? torch::full({size}, fallback) : torch::tensor(values);
}

}  // namespace

ReferenceModel::ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type)
    : m_info(std::move(info)), m_net(std::move(net)), m_type(type) {
  m_net->eval();
  m_net->to(type);
  const auto& s = m_info.standardiser;
  m_poseMean = vectorOr(s.poseMean, m_info.poseDim, 0.f).to(type);
  m_poseStd = vectorOr(s.poseStd, m_info.poseDim, 1.f).to(type);
  m_controlMean = vectorOr(s.controlMean, m_info.controlDim, 0.f).to(type);
  m_controlStd = vectorOr(s.controlStd, m_info.controlDim, 1.f).to(type);
}

/// A copy.
torch::Tensor ReferenceModel::toTensor(const Matrix& m) const {
  return torch::from_blob(const_cast<float*>(m.data()), {m.rows(), m.cols()})
      .to(m_type, /*non_blocking=*/false, /*copy=*/true);
}

RolloutState ReferenceModel::start(int batch, const Matrix& history) const {
  const c10::InferenceMode guard;
  const int64_t tau = m_info.context, d = m_info.poseDim;
  Rollout out;
  out.history = history.rows() == 0
                    ? torch::zeros({batch, tau, d}, m_type)
                    : (toTensor(history).view({batch, tau, d}) - m_poseMean) / m_poseStd;
  return {out};
}

Matrix ReferenceModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                   const Matrix& latent) const {
  const c10::InferenceMode guard;
  auto& rollout = std::any_cast<Rollout&>(state.value);
  const int64_t batch = rollout.history.size(0);
  const auto control =
      (toTensor(controlWindow).view({batch, -1, m_info.controlDim}) - m_controlMean) / m_controlStd;
  const Net::Context context{rollout.history.view({batch, 1, -1}), control.reshape({batch, 1, -1})};
  const auto x = m_net->toMotion(toTensor(latent).unsqueeze(1), context, rollout.flow);
  rollout.history = torch::cat({rollout.history.narrow(1, 1, m_info.context - 1), x}, 1);
  return toMatrix(x.squeeze(1) * m_poseStd + m_poseMean);
}

std::vector<SequenceScore> ReferenceModel::observeMany(std::span<RolloutState> states,
                                                       std::span<const ObservedSequence> sequences,
                                                       const std::function<void()>& between) const {
  std::vector<SequenceScore> out;
  for (size_t i = 0; i < sequences.size(); ++i) {
    between();
    const ObservedSequence& s = sequences[i];
    out.push_back(
        observeTargets(states[i], *s.poses, *s.controls, s.targets ? *s.targets : *s.poses));
  }
  return out;
}

SequenceScore ReferenceModel::observeTargets(RolloutState& state, const Matrix& poses,
                                             const Matrix& controls, const Matrix& targets) const {
  const c10::InferenceMode guard;
  auto& rollout = std::any_cast<Rollout&>(state.value);
  const auto x = (toTensor(poses).unsqueeze(0) - m_poseMean) / m_poseStd;
  const auto control = (toTensor(controls).unsqueeze(0) - m_controlMean) / m_controlStd;
  const auto all = torch::cat({rollout.history, x}, 1);
  const auto scored = (toTensor(targets).unsqueeze(0) - m_poseMean) / m_poseStd;
  const auto latent = m_net->toLatent(scored, m_net->contextOf(all, control), rollout.flow);
  rollout.history = all.narrow(1, all.size(1) - m_info.context, m_info.context);
  const auto density =
      (nn::baseLogDensity(latent.value, m_net->config().degreesOfFreedom()) + latent.logDet)
          .to(torch::kFloat64)
          .contiguous();
  SequenceScore out;
  out.latent = toMatrix(latent.value.squeeze(0));
  out.loglikNats.assign(density.data_ptr<double>(), density.data_ptr<double>() + density.numel());
  return out;
}

TensorFile ReferenceModel::save() const {
  if (m_type != torch::kFloat32)
    throw InputError({.path = m_info.variant}, "weights as they are stored", "doubles");
  TensorFile file;
  storeCommon(m_info, file);
  storeWeights(*m_net, file);
  return file;
}

}  // namespace marey::moglow

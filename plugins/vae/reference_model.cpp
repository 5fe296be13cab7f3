#include "vae/reference_model.h"

#include <utility>

#include "vae/clip_request.h"

#include "base/error.h"
#include "model/gradient/weights.h"
#include "model/model_parts.h"

namespace marey::vae {

ReferenceModel::ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type)
    : m_info(std::move(info)), m_net(std::move(net)), m_type(type) {
  m_net->eval();
  m_net->to(type);
  const Standardiser units = unitsOf(m_info);
  m_poseMean = torch::tensor(units.poseMean).to(type);
  m_poseStd = torch::tensor(units.poseStd).to(type);
  m_controlMean = torch::tensor(units.controlMean).to(type);
  m_controlStd = torch::tensor(units.controlStd).to(type);
}

/// A copy.
torch::Tensor ReferenceModel::toTensor(const Matrix& m) const {
  return torch::from_blob(const_cast<float*>(m.data()), {m.rows(), m.cols()})
      .to(m_type, /*non_blocking=*/false, /*copy=*/true);
}

Matrix ReferenceModel::generateOne(const ClipRequest& request) const {
  const long frames = framesOf(m_net->config(), request);
  const int64_t width = m_net->config().latent;
  const auto control = ((toTensor(request.controls) - m_controlMean) / m_controlStd).unsqueeze(0);
  const auto latents = toTensor(request.latents);
  const auto mask = torch::ones({1, frames}, m_type);
  auto poses = m_net->decode(latents.narrow(0, 0, 1).narrow(1, 0, width), control, mask).squeeze(0);
  if (m_net->config().gaussian())
    poses = poses + m_net->noise() * latents.narrow(1, width, m_info.poseDim);
  const auto out = (poses * m_poseStd + m_poseMean).to(torch::kFloat32).contiguous();
  return Eigen::Map<const Matrix>(out.data_ptr<float>(), out.size(0), out.size(1));
}

std::vector<Matrix> ReferenceModel::generate(std::span<const ClipRequest> requests,
                                             const std::function<void()>& between) const {
  const c10::InferenceMode guard;
  std::vector<Matrix> out;
  for (const ClipRequest& request : requests) {
    between();
    out.push_back(generateOne(request));
  }
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

}  // namespace marey::vae

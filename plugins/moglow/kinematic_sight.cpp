#include "moglow/kinematic_sight.h"

namespace marey::moglow {

KinematicSight::KinematicSight(const Config& c, const KinematicBody& body, int64_t rich,
                               const BufferMaker& buffer)
    : m_features(c.netFeatures) {
  const auto contacts = static_cast<int64_t>(body.contacts().size());
  m_mean = buffer("net_mean", torch::zeros({rich}));
  m_projection = buffer("net_projection", torch::zeros({rich, m_features}));
  m_speedScale = buffer("speed_scale", torch::ones({2 * contacts * (body.order() - 1)}));
  m_controlScale = buffer("control_scale", torch::ones({3 * body.order()}));
}

torch::Tensor KinematicSight::see(const KinematicBody& body, const Past& past,
                                  const torch::Tensor& rich) const {
  const auto centred = rich - m_mean;
  const int64_t speeds = m_speedScale.size(0), controls = m_controlScale.size(0),
                width = rich.size(1);
  std::vector<torch::Tensor> heights;
  for (const int64_t j : body.contacts())
    heights.push_back((past.poses.select(1, 0).select(1, j).narrow(1, 1, 1) - 10.0) / 5.0);
  return torch::cat({centred.matmul(m_projection),
                     centred.narrow(1, width - speeds, speeds) / m_speedScale,
                     centred.narrow(1, width - speeds - controls, controls) / m_controlScale,
                     torch::cat(heights, -1)},
                    -1)
      .clamp(-6.0, 6.0);
}

void KinematicSight::fit(const torch::Tensor& richRegressors) {
  const auto rich = richRegressors.to(torch::kFloat64);
  const auto mean = rich.mean(0), centred = rich - mean;
  const auto [values, vectors] =
      torch::linalg_eigh(centred.t().matmul(centred) / static_cast<double>(rich.size(0)));
  const auto count = m_features;
  // A floor of (0.2 cm)^2 keeps tiny directions from being blown up.
  m_projection.copy_(vectors.flip(1).narrow(1, 0, count) /
                     (values.flip(0).narrow(0, 0, count) + 0.04).sqrt());
  m_mean.copy_(mean);
  const auto deviation = centred.square().mean(0).sqrt().clamp_min(1e-6);
  const int64_t speeds = m_speedScale.size(0), controls = m_controlScale.size(0),
                width = rich.size(1);
  m_speedScale.copy_(deviation.narrow(0, width - speeds, speeds));
  m_controlScale.copy_(deviation.narrow(0, width - speeds - controls, controls));
}

}  // namespace marey::moglow

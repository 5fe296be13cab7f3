#include "model/gradient/training_noise.h"

#include <cmath>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

constexpr int64_t kJudgedFrames = 48;

}  // namespace

torch::Tensor TrainableModel::poseDerivatives(const TrainingFrames& /*frames*/, int64_t /*count*/) {
  throw Error("a model with an observation floor gives the derivatives of its poses");
}

TrainingNoise::TrainingNoise(const TrainableModel& net, const Standardiser& standardiser,
                             std::vector<double> floorScale, torch::Device device)
    : m_floorM(net.observationFloorM()), m_scale(std::move(floorScale)) {
  if (m_floorM <= 0.0) return;
  std::vector<float> scaled = standardiser.poseStd;
  for (size_t i = 0; i < scaled.size(); ++i)
    scaled[i] = static_cast<float>(static_cast<double>(scaled[i]) / m_scale[i]);
  m_poseStd = torch::tensor(scaled).to(device);
  m_deviation = m_floorM / m_poseStd;
}

torch::Tensor TrainingNoise::draw(const TrainingBatch& batch, at::Generator& generator) const {
  if (none()) return {};
  return torch::randn(batch.pose.sizes(), generator, torch::kFloat32).to(batch.pose.device()) *
         m_deviation;
}

ObservationNoise TrainingNoise::observation() const {
  return none() ? ObservationNoise{} : ObservationNoise{m_floorM, kObservationDraws};
}

double TrainingNoise::floorDirections(TrainableModel& net, const TrainingFrames& frames) const {
  if (none()) return std::nan("");
  const at::AutoGradMode differentiate(true);
  const auto derivatives = net.poseDerivatives(frames, kJudgedFrames);
  const auto widths = torch::linalg_svdvals(
      (derivatives.detach() * m_poseStd.unsqueeze(1)).to(torch::kCPU).to(torch::kFloat64));
  const auto narrow = widths.le(std::numbers::sqrt2 * m_floorM).sum(1).to(torch::kFloat64);
  return narrow.mean().item<double>();
}

}  // namespace marey

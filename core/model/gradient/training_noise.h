// Noise on the poses that are to be foreseen (model/observation.h), and what a trained model makes
// of it. Internal (libtorch types).
#pragma once

#include "model/gradient/trainable.h"

namespace marey {

class TrainingNoise {
 public:
  /// Undefined noise where the model has no floor.
  TrainingNoise(const TrainableModel& net, const Standardiser& standardiser,
                std::vector<double> floorScale, torch::Device device);

  bool none() const { return !m_deviation.defined(); }
  /// Standard deviations [D], standardised; undefined: none.
  const torch::Tensor& deviation() const { return m_deviation; }
  /// Of a batch, drawn on the CPU, so that a device changes no batch; undefined: none.
  torch::Tensor draw(const TrainingBatch& batch, at::Generator& generator) const;
  ObservationNoise observation() const;
  const std::vector<double>& floorScale() const { return m_scale; }
  /// Directions of pose space in which a model is at most sqrt(2) floors wide, so that at least
  /// half of its variance is the floor: singular values of its pose by its latent, in the mean over
  /// some of the frames. NaN without a floor.
  double floorDirections(TrainableModel& net, const TrainingFrames& frames) const;

 private:
  double m_floorM;
  std::vector<double> m_scale;  ///< floorScales
  torch::Tensor m_deviation;
  torch::Tensor m_poseStd;  ///< in units whose floor is floorM
};

}  // namespace marey

// MoGlow behind the MotionModel interface, on libtorch: the plain path that the engine is tested
// and measured against, in float32 or in double precision.
#pragma once

#include <memory>

#include "model/motion_model.h"
#include "moglow/net.h"

namespace marey::moglow {

class ReferenceModel : public MotionModel, public FrameGenerator, public DensityEstimator {
 public:
  ReferenceModel(ModelInfo info, std::shared_ptr<Net> net,
                 torch::ScalarType type = torch::kFloat32);
  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  const DensityEstimator* density() const override { return this; }
  RolloutState start(int batch, const Matrix& history) const override;
  Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                     const Matrix& latent) const override;
  std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                         std::span<const ObservedSequence> sequences,
                                         const std::function<void()>& between) const override;
  TensorFile save() const override;

 private:
  torch::Tensor toTensor(const Matrix& m) const;
  /// `targets` are scored, after the history that `poses` are.
  SequenceScore observeTargets(RolloutState& state, const Matrix& poses, const Matrix& controls,
                               const Matrix& targets) const;
  ModelInfo m_info;
  std::shared_ptr<Net> m_net;
  torch::ScalarType m_type;
  torch::Tensor m_poseMean, m_poseStd, m_controlMean, m_controlStd;
};

}  // namespace marey::moglow

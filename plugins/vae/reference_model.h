// The autoencoder behind the MotionModel interface, on libtorch: the plain path that the engine is
// tested against, in float32 or in double precision.
#pragma once

#include <memory>

#include "vae/net.h"

#include "model/motion_model.h"

namespace marey::vae {

class ReferenceModel : public MotionModel, public ClipGenerator {
 public:
  ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type);
  const ModelInfo& info() const override { return m_info; }
  const ClipGenerator* wholeClip() const override { return this; }
  std::vector<Matrix> generate(std::span<const ClipRequest> requests,
                               const std::function<void()>& between) const override;
  TensorFile save() const override;

 private:
  Matrix generateOne(const ClipRequest& request) const;
  torch::Tensor toTensor(const Matrix& m) const;

  ModelInfo m_info;
  std::shared_ptr<Net> m_net;
  torch::ScalarType m_type;
  torch::Tensor m_poseMean, m_poseStd, m_controlMean, m_controlStd;
};

}  // namespace marey::vae

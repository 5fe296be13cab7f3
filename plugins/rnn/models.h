// The RNN baseline as a model, on the engine and on libtorch.
#pragma once

#include <memory>

#include "rnn/net.h"

#include "nn/engine/recurrent_net.h"

namespace marey::rnn {

/// On packed weights.
class EngineModel : public MotionModel, public FrameGenerator {
 public:
  /// `file` holds checked weights.
  EngineModel(ModelInfo info, const Config& config, TensorFile file, nn::Precision precision);
  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  RolloutState start(int batch, const Matrix& history) const override;
  Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                     const Matrix& latent) const override;
  TensorFile save() const override;

 private:
  ModelInfo m_info;
  Config m_config;
  Standardiser m_units;
  TensorFile m_file;
  nn::RecurrentNet m_net;
};

/// On libtorch, in float32 or in double precision.
class ReferenceModel : public MotionModel, public FrameGenerator {
 public:
  ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type);
  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  RolloutState start(int batch, const Matrix& history) const override;
  Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                     const Matrix& latent) const override;
  TensorFile save() const override;

 private:
  ModelInfo m_info;
  std::shared_ptr<Net> m_net;
  torch::ScalarType m_type;
  Standardiser m_units;
};

}  // namespace marey::rnn

// MoGlow behind the MotionModel interface, on the flow engine, with the base below it where there
// is one. No libtorch type appears here.
#pragma once

#include <memory>

#include "model/motion_model.h"
#include "moglow/engine_base.h"
#include "nn/flow/flow_engine.h"

namespace marey::moglow {

class EngineModel : public MotionModel, public FrameGenerator, public DensityEstimator {
 public:
  /// `file` holds the checked weights; the flow's large ones are kept packed only. `base`: null
  /// without one; `motion`: that of samples, null where it is `base`. Throws InputError for a
  /// singular linear layer.
  EngineModel(ModelInfo info, const Config& config, TensorFile file,
              std::unique_ptr<const EngineBase> base, std::unique_ptr<const EngineBase> motion,
              nn::Precision precision, const std::string& origin);
  ~EngineModel() override;

  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  const DensityEstimator* density() const override { return this; }
  RolloutState start(int batch, const Matrix& history) const override;
  Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                     const Matrix& latent) const override;
  std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                         std::span<const ObservedSequence> sequences,
                                         const std::function<void()>& between) const override;
  /// Throws InputError when the weights were rounded on loading.
  TensorFile save() const override;

 private:
  struct Rollout;
  class Observation;
  long historyWidth() const { return static_cast<long>(m_config.tau) * m_config.poseDim; }
  long controlWidth() const {
    return static_cast<long>(m_config.tau + 1 + m_config.lookahead) * m_config.controlDim;
  }
  /// Columns of what the base and the flow's passed channels give to the nets.
  long featureWidth() const { return m_base ? m_config.conditioning() : 0; }
  const EngineBase* motionBase() const { return m_motion ? m_motion.get() : m_base.get(); }

  ModelInfo m_info;
  Config m_config;
  Standardiser m_units;  ///< zeros and ones where the model has none
  TensorFile m_kept;     ///< everything but what is packed
  nn::FlowEngine m_flow;
  std::unique_ptr<const EngineBase> m_base;    ///< of densities
  std::unique_ptr<const EngineBase> m_motion;  ///< of samples; null where that is m_base
};

}  // namespace marey::moglow

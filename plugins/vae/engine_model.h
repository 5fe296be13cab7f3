// The autoencoder behind the MotionModel interface, on the engine: motions are made by the decoder,
// all of a call together. No libtorch type appears here.
#pragma once

#include "vae/config.h"

#include "model/motion_model.h"
#include "nn/engine/bidirectional_stack.h"

namespace marey::vae {

class EngineModel : public MotionModel, public ClipGenerator {
 public:
  /// `file` holds the checked weights.
  EngineModel(ModelInfo info, const Config& config, TensorFile file, nn::Precision precision);

  const ModelInfo& info() const override { return m_info; }
  const ClipGenerator* wholeClip() const override { return this; }
  std::vector<Matrix> generate(std::span<const ClipRequest> requests,
                               const std::function<void()>& between) const override;
  TensorFile save() const override;

 private:
  struct Group;
  void writeInputs(const Group& group, nn::AlignedFloats& out) const;
  void toPoses(const Group& group, const nn::Inputs& hidden, const std::function<void()>& between,
               std::vector<Matrix>& out) const;
  long inputs() const { return m_config.controlDim + m_config.latent; }

  ModelInfo m_info;
  Config m_config;
  Standardiser m_units;
  TensorFile m_kept;  ///< as it was loaded
  nn::BidirectionalStack m_decoder;
  nn::PackedMatrix m_output;
  nn::AlignedFloats m_outputBias;
  std::vector<float> m_noise;  ///< standard deviations; empty for a deterministic decoder
};

}  // namespace marey::vae

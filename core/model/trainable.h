// What a family gives the trainer. Internal to nn, model and the families (libtorch types).
#pragma once

#include "base/json.h"
#include "model/motion_model.h"
#include "nn/torch.h"

namespace marey {

/// A batch of windows of standardised values.
struct TrainingBatch {
  torch::Tensor pose;        ///< [B, W, D]
  torch::Tensor control;     ///< [B, W, C]
  torch::Tensor mask;        ///< [B, W], 1 where a frame is real
  torch::Tensor keep;        ///< [B, ...], 0 where training hides something; undefined: nowhere
  torch::Tensor noise = {};  ///< [B, W, D], on the poses that are to be foreseen; undefined: none

  /// Some of the windows.
  TrainingBatch narrow(int64_t first, int64_t count) const {
    return {pose.narrow(0, first, count), control.narrow(0, first, count),
            mask.narrow(0, first, count), keep.defined() ? keep.narrow(0, first, count) : keep,
            noise.defined() ? noise.narrow(0, first, count) : noise};
  }
};

/// Frames for data-dependent starts: the standardised training sequences, one after the other.
struct TrainingFrames {
  torch::Tensor pose;     ///< [N, D]
  torch::Tensor control;  ///< [N, C]
  torch::Tensor usable;   ///< [M] int64: indices with `context` frames of the same sequence before
                          ///< and `lookahead` after them
  torch::Tensor noise = {};  ///< [D]: of the noise on what is to be foreseen; undefined:
                             ///< none
};

class TrainableModel : public torch::nn::Module {
 public:
  virtual int64_t context() const = 0;
  virtual int64_t lookahead() const = 0;
  /// What training hides from the nets, for a batch of such windows; undefined where nothing.
  virtual torch::Tensor drawDropout(const TrainingBatch& batch, at::Generator& generator) const = 0;
  /// Log-density in nats [B, W - context - lookahead] of frames context .. W - lookahead - 1.
  virtual torch::Tensor logLikelihood(const TrainingBatch& batch) = 0;
  /// Data-dependent start. Returns facts for the log and the model card.
  virtual Json initialise(const TrainingFrames& frames) = 0;
  /// Standard deviation of the observation noise that the model is trained and scored with,
  /// metres; 0: none.
  virtual double observationFloorM() const { return 0.0; }
  /// Derivatives [N, D, D] of poses by latents, standardised, at some of the frames and at latents
  /// of the base distribution. Asked of models with an observation floor only.
  virtual torch::Tensor poseDerivatives(const TrainingFrames& frames, int64_t count);

  /// Whether logLikelihood takes the fast path, where there is one for its device and type.
  Execution execution = Execution::Engine;
};

}  // namespace marey

// What a family gives the trainer. Internal to nn, model and the families (libtorch types).
#pragma once

#include "base/json.h"
#include "model/motion_model.h"
#include "nn/torch.h"

namespace marey {

/// A batch of windows of standardised values.
struct TrainingBatch {
  torch::Tensor pose;     ///< [B, W, D]
  torch::Tensor control;  ///< [B, W, C]
  torch::Tensor mask;     ///< [B, W], 1 where a frame is real
  torch::Tensor keep;     ///< [B, ...], 0 where training hides something; undefined: nowhere

  /// Some of the windows.
  TrainingBatch narrow(int64_t first, int64_t count) const {
    return {pose.narrow(0, first, count), control.narrow(0, first, count),
            mask.narrow(0, first, count), keep.defined() ? keep.narrow(0, first, count) : keep};
  }
};

/// Frames for data-dependent starts: the standardised training sequences, one after the other.
struct TrainingFrames {
  torch::Tensor pose;     ///< [N, D]
  torch::Tensor control;  ///< [N, C]
  torch::Tensor usable;   ///< [M] int64: indices with `context` frames of the same sequence before
                          ///< and `lookahead` after them
};

class TrainableModel : public torch::nn::Module {
 public:
  virtual int64_t context() const = 0;
  virtual int64_t lookahead() const = 0;
  /// What training hides from the nets, for a batch of such windows; undefined where nothing.
  virtual torch::Tensor drawDropout(const TrainingBatch& batch, at::Generator& generator) const = 0;
  /// Log-density in nats [B, W - context - lookahead] of frames context .. W - lookahead - 1.
  virtual torch::Tensor logLikelihood(const TrainingBatch& batch) = 0;
  /// Data-dependent start. Returns facts for the log and the model card
  /// ("linear_gaussian_nats_per_frame": the floor that a flow has to beat).
  virtual Json initialise(const TrainingFrames& frames) = 0;

  /// Whether logLikelihood takes the fast path, where there is one for its device and type.
  Execution execution = Execution::Engine;
};

}  // namespace marey

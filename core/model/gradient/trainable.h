// What a family gives the trainer. Internal to nn, model and the families (libtorch types).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "model/gradient/objective.h"
#include "model/model_family.h"
#include "nn/torch/torch.h"

namespace marey {

/// A batch of windows of standardised values.
struct TrainingBatch {
  torch::Tensor pose;        ///< [B, W, D]
  torch::Tensor control;     ///< [B, W, C]
  torch::Tensor mask;        ///< [B, W], 1 where a frame is real
  torch::Tensor draws = {};  ///< [B, ...], what TrainableModel::draw gave; undefined: none
  torch::Tensor noise = {};  ///< [B, W, D], on the poses that are to be foreseen; undefined: none
  int64_t step = 0;          ///< steps of training before this one, for what warms up
  torch::Tensor seen = {};  ///< [B, W, D]: poses as the nets are given them; undefined: as they are
  /// [B, W]: 1 where the frames that follow are given the net's own pose of a frame instead
  /// (TrainableModel::seesOwnPoses); undefined: nowhere.
  torch::Tensor own = {};

  const torch::Tensor& seenPose() const { return seen.defined() ? seen : pose; }
  /// Some of the windows.
  TrainingBatch narrow(int64_t first, int64_t count) const {
    const auto part = [&](const torch::Tensor& t) {
      return t.defined() ? t.narrow(0, first, count) : t;
    };
    return {part(pose),  part(control), part(mask), part(draws),
            part(noise), step,          part(seen), part(own)};
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

/// Of a batch.
struct Loss {
  torch::Tensor sum;  ///< over what TrainableModel::weight counts; differentiable
  /// Named parts of the sum, for the log; empty where it has none.
  std::vector<std::pair<std::string, torch::Tensor>> terms = {};
};

class TrainableModel : public torch::nn::Module {
 public:
  virtual Objective objective() const = 0;
  virtual int64_t context() const = 0;
  virtual int64_t lookahead() const = 0;
  /// Random numbers that the loss of such a batch needs (what dropout hides, latents); undefined
  /// where none. Evaluations give none.
  virtual torch::Tensor draw(const TrainingBatch& /*batch*/, at::Generator& /*generator*/) const {
    return {};
  }
  /// Whether it can be trained on poses that it made itself (scheduled sampling, Bengio et al.
  /// 2015): then its loss heeds TrainingBatch::own.
  virtual bool seesOwnPoses() const { return false; }
  /// Of frames context .. W - lookahead - 1 of every window, those that are padding left out.
  virtual Loss loss(const TrainingBatch& batch) = 0;
  /// What the loss is a sum over: as a rule the real ones of those frames.
  virtual double weight(const TrainingBatch& batch) const {
    return scoredMask(batch).sum().item<double>();
  }
  /// [B, W - context - lookahead], 1 where such a frame is real.
  torch::Tensor scoredMask(const TrainingBatch& batch) const {
    return batch.mask.narrow(1, context(), batch.mask.size(1) - context() - lookahead());
  }
  /// Data-dependent start. Returns facts for the log and the model card.
  virtual Json initialise(const TrainingFrames& /*frames*/) { return Json::object(); }
  /// Standard deviation of the observation noise that the model is trained and scored with,
  /// metres; 0: none.
  virtual double observationFloorM() const { return 0.0; }
  /// Derivatives [N, D, D] of poses by latents, standardised, at some of the frames and at latents
  /// of the base distribution. Asked of models with an observation floor only.
  virtual torch::Tensor poseDerivatives(const TrainingFrames& frames, int64_t count);

  /// Whether the loss takes the fast path, where there is one for its device and type.
  Execution execution = Execution::Engine;
};

}  // namespace marey

// First-order optimisers over named parameters. Their own few lines rather than libtorch's, whose
// stored state changed its form between 1.13 and 2.x. Internal (libtorch types).
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/gradient/training_config.h"
#include "model/motion_model.h"
#include "nn/torch/torch.h"

namespace marey {

/// What becomes of a gradient before it is used: clamped to +-limit, then scaled.
struct GradientClip {
  double limit = std::numeric_limits<double>::infinity();
  double scale = 1.0;
};

class Optimiser {
 public:
  virtual ~Optimiser() = default;
  /// Names under which the moments of a slot are stored: "adam_mean", ...
  virtual const std::vector<std::string>& momentNames() const = 0;
  /// One step with the gradients in place; `count` is the number of this step, from 1. Parameters
  /// without a gradient stay as they are.
  void step(double rate, int64_t count, const GradientClip& clip = {});

  struct Slot {
    torch::Tensor parameter;
    std::vector<torch::Tensor> moments;  ///< of the parameter's shape, zero at first
  };
  std::map<std::string, Slot> slots;  ///< by the parameter's name

 protected:
  Optimiser(const torch::nn::Module& module, size_t moments);

 private:
  virtual void update(Slot& slot, const torch::Tensor& gradient, double rate, int64_t count,
                      const GradientClip& clip) const = 0;
};

/// Clamped and scaled.
torch::Tensor clipped(const torch::Tensor& gradient, const GradientClip& clip);

/// The one that the configuration names. `execution`: the reference is a chain of libtorch's
/// operations; the engine may make one pass of its own over float32 values on the CPU.
std::unique_ptr<Optimiser> makeOptimiser(const TrainingConfig& config,
                                         const torch::nn::Module& module, Execution execution);

}  // namespace marey

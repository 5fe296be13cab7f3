// Adam (Kingma and Ba 2015) over named parameters. Its own few lines rather than libtorch's
// optimiser, whose stored state changed its form between 1.13 and 2.x. Internal (libtorch types).
#pragma once

#include <limits>
#include <map>
#include <string>

#include "model/motion_model.h"
#include "nn/torch/torch.h"

namespace marey {

/// What becomes of a gradient before it is used: clamped to +-limit, then scaled.
struct GradientClip {
  double limit = std::numeric_limits<double>::infinity();
  double scale = 1.0;
};

class Adam {
 public:
  /// The engine makes one pass over float32 values on the CPU; the reference is a chain of
  /// libtorch's operations, and what runs everywhere else.
  explicit Adam(const torch::nn::Module& module, Execution execution = Execution::Engine);
  /// One step with the gradients in place; `count` is the number of this step, from 1.
  void step(double rate, int64_t count, const GradientClip& clip = {});

  struct Slot {
    torch::Tensor parameter, mean, square;
  };
  std::map<std::string, Slot> slots;

 private:
  Execution m_execution;
};

}  // namespace marey

// The fast path of a flow from data to latent over whole sequences, with its gradient: what
// training and validation run on. Flow::toLatent is its oracle (tests/laws/fast_training_test.cpp).
#pragma once

#include "nn/flow/flow.h"

namespace marey::nn {

/// What the coupling nets see beside the passed channels.
struct FlowConditioning {
  torch::Tensor values;  ///< [B, T, C]
  /// [B, T, N], 0 where a block of `values` is zero: block i is columns i * width .. of it.
  /// Undefined: nothing is known.
  torch::Tensor keep;
  int64_t blockWidth = 0;
};

/// Whether the fast path takes these: float32 on the CPU, recurrent nets with widths in multiples
/// of 32, and conditioning that asks for no gradient.
bool takesFastPath(const Flow& flow, const torch::Tensor& x, const FlowConditioning& conditioning);

/// As Flow::toLatent from a fresh state, up to rounding. Only what takesFastPath. Throws torch's
/// c10::Error when the gradient is asked for a second time.
Transformed fastToLatent(const Flow& flow, const torch::Tensor& x,
                         const FlowConditioning& conditioning);

}  // namespace marey::nn

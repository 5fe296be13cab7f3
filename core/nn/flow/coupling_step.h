// One step of a flow (actnorm and linear map, then the affine coupling) over whole sequences, with
// a gradient of its own: the fast path of training. Internal to nn.
#pragma once

#include <memory>
#include <vector>

#include "nn/flow/flow.h"
#include "nn/torch/torch.h"

namespace marey::nn {

/// What all steps of a flow share in one pass. Rows are time-major: sequence b at frame t is row
/// t * batch + b.
struct StepCall {
  int64_t frames = 0, batch = 0, passed = 0;
  CouplingNetSpec net;
  /// Inputs of the nets [rows, passed + C']: every step writes its passed channels in front of the
  /// conditioning, which is the same for all.
  torch::Tensor inputs;
  /// Conditioning that is zero in most rows, and left out of `inputs`.
  struct Block {
    int64_t column = 0;    ///< of the nets' input weights
    torch::Tensor rows;    ///< int64 [M]: where it is not zero
    torch::Tensor values;  ///< [M, width]
  };
  std::vector<Block> blocks;  ///< side by side, right behind the passed channels
};

struct StepOutput {
  torch::Tensor value;   ///< [rows, D]
  torch::Tensor logDet;  ///< [rows]: of the coupling alone
};

/// h = x weight' + offset, then the coupling. `net` in the order of CouplingNet::weights().
/// float32 on the CPU; hidden widths of recurrent nets are multiples of 32. The gradient can be
/// asked for once.
StepOutput couplingStep(const torch::Tensor& x, const torch::Tensor& weight,
                        const torch::Tensor& offset, const std::vector<torch::Tensor>& net,
                        std::shared_ptr<const StepCall> call);

}  // namespace marey::nn

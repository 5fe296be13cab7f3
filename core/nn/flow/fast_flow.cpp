#include "nn/flow/fast_flow.h"

#include "nn/engine/kernels/kernels.h"
#include "nn/flow/coupling_step.h"

namespace marey::nn {
namespace {

using torch::Tensor;

/// Up to this share of rows with a block in them, products with those rows alone pay.
constexpr double kSparse = 0.5;

/// [B, T, F] -> [T * B, F].
Tensor timeMajor(const Tensor& t) {
  return t.transpose(0, 1).contiguous().view({t.size(0) * t.size(1), t.size(2)});
}

std::shared_ptr<const StepCall> stepCall(const Flow& flow, const Tensor& x,
                                         const FlowConditioning& c) {
  const torch::NoGradGuard guard;
  auto call = std::make_shared<StepCall>();
  call->frames = x.size(1);
  call->batch = x.size(0);
  call->passed = flow.spec().channels / 2;
  call->net = flow.spec().net;
  const auto values = timeMajor(c.values);
  int64_t left = 0;  // columns that go into blocks
  if (c.keep.defined() && c.keep.mean().item<double>() <= kSparse) {
    const auto keep = timeMajor(c.keep);
    left = keep.size(1) * c.blockWidth;
    for (int64_t i = 0; i < keep.size(1); ++i) {
      const auto rows = keep.select(1, i).nonzero().flatten();
      call->blocks.push_back(
          {call->passed + i * c.blockWidth, rows,
           values.narrow(1, i * c.blockWidth, c.blockWidth).index_select(0, rows)});
    }
  }
  call->inputs = at::empty({values.size(0), call->passed + values.size(1) - left}, x.options());
  call->inputs.narrow(1, call->passed, values.size(1) - left)
      .copy_(values.narrow(1, left, values.size(1) - left));
  return call;
}

}  // namespace

bool takesFastPath(const Flow& flow, const Tensor& x, const FlowConditioning& conditioning) {
  const CouplingNetSpec& net = flow.spec().net;
  const Tensor& weight = flow.steps().front().actnorm->bias;
  return x.is_cpu() && x.scalar_type() == torch::kFloat32 &&
         weight.scalar_type() == torch::kFloat32 && !conditioning.values.requires_grad() &&
         (net.cell == "feedforward" || net.hidden % kPanel == 0);
}

Transformed fastToLatent(const Flow& flow, const Tensor& x, const FlowConditioning& conditioning) {
  const auto call = stepCall(flow, x, conditioning);
  StepOutput out{timeMajor(x), {}};
  Tensor frameLogDet = torch::zeros({}, x.options()), logDet = torch::zeros({}, x.options());
  for (const Flow::Step& step : flow.steps()) {
    const auto& logs = step.actnorm->logs;
    // Actnorm and linear map as one.
    const auto weight = step.linear->weight() * logs.exp();
    out = couplingStep(out.value, weight, weight.mv(step.actnorm->bias),
                       step.coupling->net().weights(), call);
    logDet = logDet + out.logDet;
    frameLogDet = frameLogDet + logs.sum() + step.linear->logDet();
  }
  const auto batchMajor = [&](const Tensor& t) {
    return t.unflatten(0, at::IntArrayRef{x.size(1), x.size(0)}).transpose(0, 1);
  };
  return {batchMajor(out.value), batchMajor(logDet) + frameLogDet};
}

}  // namespace marey::nn

#include "nn/flow/coupling_step.h"

#include <cmath>

#include "nn/engine/kernels/kernels.h"
#include "nn/flow/net_pass.h"

namespace marey::nn {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr float kLeast = 1e-6f;  ///< added to every scale
constexpr int64_t kRowsTogether = 64;

/// Channels of a coupling's changed half, in the layout of its net's outputs: all shifts, then all
/// scales, each rounded up to whole vectors.
struct HalfLayout {
  explicit HalfLayout(int64_t channels)
      : count(channels), padded((channels + kLanes - 1) / kLanes * kLanes) {}
  int64_t count, padded;

  /// The output layer's weights [2 * count, ...], which alternate, in that layout.
  Tensor arranged(const Tensor& alternating) const {
    auto shape = alternating.sizes().vec();
    shape[0] = 2 * padded;
    auto out = at::zeros(shape, alternating.options());
    for (int64_t half = 0; half < 2; ++half)
      out.narrow(0, half * padded, count).copy_(alternating.slice(0, half, 2 * count, 2));
    return out;
  }
  Tensor alternating(const Tensor& arranged) const {
    auto shape = arranged.sizes().vec();
    shape[0] = 2 * count;
    auto out = at::empty(shape, arranged.options());
    for (int64_t half = 0; half < 2; ++half)
      out.slice(0, half, 2 * count, 2).copy_(arranged.narrow(0, half * padded, count));
    return out;
  }
};

/// One row of `mixed` -> `value`; the raw scales in `net` become scales. Returns their log-sum.
double coupleRow(const HalfLayout& half, int64_t passed, const float* mixed, float* net,
                 float* value) {
  float* scales = net + half.padded;
  kernels().sigmoid(scales, scales, half.padded / kLanes);
  std::copy_n(mixed, passed, value);
  double sum = 0.0;
  for (int64_t first = 0; first < half.count; first += kLanes) {
    // One logarithm for sixteen scales: in float64 their product cannot underflow.
    double product = 1.0;
    for (int64_t j = first; j < std::min(first + kLanes, half.count); ++j) {
      scales[j] += kLeast;
      value[passed + j] = (mixed[passed + j] + net[j]) * scales[j];
      product *= scales[j];
    }
    sum += std::log(product);
  }
  return sum;
}

/// Gradients: by the net's outputs in their place, by the changed half of `mixed` into
/// `mixedGradient`; the passed half is copied.
void coupleRowBackward(const HalfLayout& half, int64_t passed, const float* mixed, float* net,
                       const float* gradient, float logDetGradient, float* mixedGradient) {
  float* scales = net + half.padded;
  std::copy_n(gradient, passed, mixedGradient);
  for (int64_t j = 0; j < half.count; ++j) {
    const float scale = scales[j], sigmoid = scale - kLeast, above = gradient[passed + j];
    const float ofScale = above * (mixed[passed + j] + net[j]) + logDetGradient / scale;
    mixedGradient[passed + j] = net[j] = above * scale;
    scales[j] = ofScale * sigmoid * (1.f - sigmoid);
  }
  for (int64_t j = half.count; j < half.padded; ++j) net[j] = scales[j] = 0.f;
}

/// What forward leaves for backward.
struct StepMemory : torch::CustomClassHolder {
  StepMemory(std::vector<Tensor> weights, std::shared_ptr<const StepCall> call)
      : net(std::move(weights), call), call(std::move(call)) {}
  NetPass net;
  std::shared_ptr<const StepCall> call;
  Tensor mixed;      ///< [rows, D]: after the linear map
  Tensor top;        ///< [rows, hidden]
  Tensor outWeight;  ///< arranged
  Tensor out;        ///< shifts and scales
  bool wantsInput = false;
};

class CouplingStep : public torch::autograd::Function<CouplingStep> {
 public:
  static variable_list forward(AutogradContext* context, const Tensor& x, const Tensor& weight,
                               const Tensor& offset, at::TensorList net,
                               const std::shared_ptr<const StepCall>& call) {
    const auto layers = net.slice(0, net.size() - 2).vec();
    auto memory = c10::make_intrusive<StepMemory>(layers, call);
    memory->wantsInput = x.requires_grad();
    memory->mixed = at::addmm(offset, x, weight.t());
    const int64_t passed = call->passed, channels = x.size(1);
    const HalfLayout half(channels - passed);
    memory->top = memory->net.forward(memory->mixed.narrow(1, 0, passed));
    memory->outWeight = half.arranged(net[net.size() - 2]);
    auto outBias = half.arranged(net[net.size() - 1]);
    outBias.narrow(0, half.padded, half.count).add_(2.0);
    memory->out = at::addmm(outBias, memory->top, memory->outWeight.t());
    auto value = at::empty_like(x);
    auto logDet = at::empty({x.size(0)}, x.options());
    const auto* mixed = memory->mixed.data_ptr<float>();
    auto *out = memory->out.data_ptr<float>(), *to = value.data_ptr<float>(),
         *sums = logDet.data_ptr<float>();
    at::parallel_for(0, x.size(0), kRowsTogether, [&](int64_t begin, int64_t end) {
      for (int64_t r = begin; r < end; ++r)
        sums[r] = static_cast<float>(coupleRow(half, passed, mixed + r * channels,
                                               out + r * 2 * half.padded, to + r * channels));
    });
    context->save_for_backward({x, weight});
    context->saved_data["memory"] = c10::IValue::make_capsule(std::move(memory));
    return {value, logDet};
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const auto saved = context->get_saved_variables();
    auto& memory = static_cast<StepMemory&>(*context->saved_data["memory"].toCapsule());
    const Tensor& x = saved[0];
    const int64_t passed = memory.call->passed;
    const HalfLayout half(x.size(1) - passed);
    const auto ofMixed = coupleBackward(memory, half, gradients);
    const Tensor& ofOut = memory.out;
    const auto ofTop = at::mm(ofOut, memory.outWeight);
    auto net =
        memory.net.backward(ofTop, memory.mixed.narrow(1, 0, passed), ofMixed.narrow(1, 0, passed));
    variable_list out{memory.wantsInput ? at::mm(ofMixed, saved[1]) : Tensor(),
                      at::mm(ofMixed.t(), x), ofMixed.sum(0)};
    out.insert(out.end(), net.begin(), net.end());
    out.push_back(half.alternating(at::mm(ofOut.t(), memory.top)));
    out.push_back(half.alternating(ofOut.sum(0)));
    out.emplace_back();  // of what is no tensor
    context->saved_data.clear();
    return out;
  }

 private:
  static Tensor coupleBackward(StepMemory& memory, const HalfLayout& half,
                               const variable_list& gradients) {
    const int64_t rows = memory.mixed.size(0), channels = memory.mixed.size(1);
    const auto above =
        gradients[0].defined() ? gradients[0].contiguous() : at::zeros_like(memory.mixed);
    const auto ofLogDet = gradients[1].defined() ? gradients[1].contiguous()
                                                 : at::zeros({rows}, memory.mixed.options());
    auto out = at::empty_like(memory.mixed);
    const auto *from = above.data_ptr<float>(), *sums = ofLogDet.data_ptr<float>(),
               *mixed = memory.mixed.data_ptr<float>();
    auto *net = memory.out.data_ptr<float>(), *to = out.data_ptr<float>();
    at::parallel_for(0, rows, kRowsTogether, [&](int64_t begin, int64_t end) {
      for (int64_t r = begin; r < end; ++r)
        coupleRowBackward(half, memory.call->passed, mixed + r * channels,
                          net + r * 2 * half.padded, from + r * channels, sums[r],
                          to + r * channels);
    });
    return out;
  }
};

}  // namespace

StepOutput couplingStep(const Tensor& x, const Tensor& weight, const Tensor& offset,
                        const std::vector<Tensor>& net, std::shared_ptr<const StepCall> call) {
  const auto out = CouplingStep::apply(x, weight, offset, at::TensorList(net), call);
  return {out[0], out[1]};
}

}  // namespace marey::nn

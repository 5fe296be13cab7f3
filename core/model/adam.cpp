#include "model/adam.h"

#include <algorithm>
#include <cmath>

#include "nn/engine/kernels/kernels.h"

namespace marey {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8;
constexpr int64_t kBlocksTogether = 1024;

struct Corrections {
  double mean, square;
};

void plainStep(Adam::Slot& slot, const torch::Tensor& raw, double rate, const Corrections& c,
               const GradientClip& clip) {
  auto gradient = std::isfinite(clip.limit) ? raw.clamp(-clip.limit, clip.limit) : raw;
  if (clip.scale != 1.0) gradient = gradient * clip.scale;
  slot.mean.mul_(kBeta1).add_(gradient, 1.0 - kBeta1);
  slot.square.mul_(kBeta2).addcmul_(gradient, gradient, 1.0 - kBeta2);
  const auto denominator = (slot.square.sqrt() / std::sqrt(c.square)).add_(kEpsilon);
  slot.parameter.addcdiv_(slot.mean, denominator, -rate / c.mean);
}

/// The values after the last whole block, through copies of a block's length.
void tailStep(nn::AdamStep step, int64_t count) {
  float copies[4][nn::kLanes] = {};
  float* const values[] = {step.parameter, step.mean, step.square};
  for (int i = 0; i < 3; ++i) std::copy_n(values[i], count, copies[i]);
  std::copy_n(step.gradient, count, copies[3]);
  step.parameter = copies[0];
  step.mean = copies[1];
  step.square = copies[2];
  step.gradient = copies[3];
  step.blocks = 1;
  nn::kernels().adam(step);
  for (int i = 0; i < 3; ++i) std::copy_n(copies[i], count, values[i]);
}

void fusedStep(Adam::Slot& slot, const torch::Tensor& raw, double rate, const Corrections& c,
               const GradientClip& clip) {
  const auto gradient = raw.contiguous();
  const nn::AdamStep whole{.parameter = slot.parameter.data_ptr<float>(),
                           .mean = slot.mean.data_ptr<float>(),
                           .square = slot.square.data_ptr<float>(),
                           .gradient = gradient.data_ptr<float>(),
                           .limit = static_cast<float>(clip.limit),
                           .gradientScale = static_cast<float>(clip.scale),
                           .beta1 = static_cast<float>(kBeta1),
                           .beta2 = static_cast<float>(kBeta2),
                           .epsilon = static_cast<float>(kEpsilon),
                           .rest1 = static_cast<float>(1.0 - kBeta1),
                           .rest2 = static_cast<float>(1.0 - kBeta2),
                           .rate = static_cast<float>(rate / c.mean),
                           .squareScale = static_cast<float>(1.0 / std::sqrt(c.square))};
  const auto from = [&](int64_t at) {
    nn::AdamStep part = whole;
    part.parameter += at;
    part.mean += at;
    part.square += at;
    part.gradient += at;
    return part;
  };
  const int64_t count = gradient.numel(), blocks = count / nn::kLanes;
  at::parallel_for(0, blocks, kBlocksTogether, [&](int64_t begin, int64_t end) {
    nn::AdamStep part = from(begin * nn::kLanes);
    part.blocks = end - begin;
    nn::kernels().adam(part);
  });
  if (const int64_t done = blocks * nn::kLanes; done < count) tailStep(from(done), count - done);
}

}  // namespace

Adam::Adam(const torch::nn::Module& module, Execution execution) : m_execution(execution) {
  for (const auto& item : module.named_parameters())
    slots[item.key()] = {item.value(), torch::zeros_like(item.value()),
                         torch::zeros_like(item.value())};
}

void Adam::step(double rate, int64_t count, const GradientClip& clip) {
  const torch::NoGradGuard guard;
  const Corrections corrections{1.0 - std::pow(kBeta1, static_cast<double>(count)),
                                1.0 - std::pow(kBeta2, static_cast<double>(count))};
  for (auto& [name, slot] : slots) {
    const auto& gradient = slot.parameter.grad();
    if (!gradient.defined()) continue;
    const bool fused = m_execution == Execution::Engine && slot.parameter.is_cpu() &&
                       slot.parameter.is_contiguous() &&
                       slot.parameter.scalar_type() == torch::kFloat32;
    (fused ? fusedStep : plainStep)(slot, gradient, rate, corrections, clip);
  }
}

}  // namespace marey

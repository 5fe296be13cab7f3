#include "model/gradient/adam.h"

#include <algorithm>
#include <cmath>

#include "nn/engine/kernels/kernels.h"

namespace marey {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8;
constexpr int64_t kBlocksTogether = 1024;
constexpr size_t kMean = 0, kSquare = 1;  ///< moments

struct Corrections {
  double mean, square;
};

void plainStep(Optimiser::Slot& slot, const torch::Tensor& raw, double rate, const Corrections& c,
               const GradientClip& clip) {
  const auto gradient = clipped(raw, clip);
  torch::Tensor &mean = slot.moments[kMean], &square = slot.moments[kSquare];
  mean.mul_(kBeta1).add_(gradient, 1.0 - kBeta1);
  square.mul_(kBeta2).addcmul_(gradient, gradient, 1.0 - kBeta2);
  const auto denominator = (square.sqrt() / std::sqrt(c.square)).add_(kEpsilon);
  slot.parameter.addcdiv_(mean, denominator, -rate / c.mean);
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

void fusedStep(Optimiser::Slot& slot, const torch::Tensor& raw, double rate, const Corrections& c,
               const GradientClip& clip) {
  const auto gradient = raw.contiguous();
  const nn::AdamStep whole{.parameter = slot.parameter.data_ptr<float>(),
                           .mean = slot.moments[kMean].data_ptr<float>(),
                           .square = slot.moments[kSquare].data_ptr<float>(),
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

Adam::Adam(const torch::nn::Module& module, Execution execution)
    : Optimiser(module, 2), m_execution(execution) {}

const std::vector<std::string>& Adam::momentNames() const {
  static const std::vector<std::string> names{"adam_mean", "adam_square"};
  return names;
}

void Adam::update(Slot& slot, const torch::Tensor& gradient, double rate, int64_t count,
                  const GradientClip& clip) const {
  const Corrections corrections{1.0 - std::pow(kBeta1, static_cast<double>(count)),
                                1.0 - std::pow(kBeta2, static_cast<double>(count))};
  const bool fused = m_execution == Execution::Engine && slot.parameter.is_cpu() &&
                     slot.parameter.is_contiguous() &&
                     slot.parameter.scalar_type() == torch::kFloat32;
  (fused ? fusedStep : plainStep)(slot, gradient, rate, corrections, clip);
}

}  // namespace marey

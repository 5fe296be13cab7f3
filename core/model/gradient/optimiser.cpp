#include "model/gradient/optimiser.h"

#include <cmath>

#include "model/gradient/adam.h"
#include "model/gradient/rms_prop.h"

namespace marey {

Optimiser::Optimiser(const torch::nn::Module& module, size_t moments) {
  for (const auto& item : module.named_parameters()) {
    Slot& slot = slots[item.key()];
    slot.parameter = item.value();
    for (size_t i = 0; i < moments; ++i) slot.moments.push_back(torch::zeros_like(item.value()));
  }
}

void Optimiser::step(double rate, int64_t count, const GradientClip& clip) {
  const torch::NoGradGuard guard;
  for (auto& [name, slot] : slots) {
    const auto& gradient = slot.parameter.grad();
    if (gradient.defined()) update(slot, gradient, rate, count, clip);
  }
}

torch::Tensor clipped(const torch::Tensor& gradient, const GradientClip& clip) {
  const auto within =
      std::isfinite(clip.limit) ? gradient.clamp(-clip.limit, clip.limit) : gradient;
  return clip.scale != 1.0 ? within * clip.scale : within;
}

std::unique_ptr<Optimiser> makeOptimiser(const TrainingConfig& config,
                                         const torch::nn::Module& module, Execution execution) {
  if (config.optimiser == "rmsprop") return std::make_unique<RmsProp>(module, config.rmsDecay);
  return std::make_unique<Adam>(module, execution);
}

}  // namespace marey

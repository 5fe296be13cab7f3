#include "model/gradient/rms_prop.h"

namespace marey {
namespace {

constexpr double kEpsilon = 1e-8;

}  // namespace

RmsProp::RmsProp(const torch::nn::Module& module, double decay)
    : Optimiser(module, 1), m_decay(decay) {}

const std::vector<std::string>& RmsProp::momentNames() const {
  static const std::vector<std::string> names{"rmsprop_square"};
  return names;
}

void RmsProp::update(Slot& slot, const torch::Tensor& gradient, double rate, int64_t /*count*/,
                     const GradientClip& clip) const {
  const auto used = clipped(gradient, clip);
  torch::Tensor& square = slot.moments.front();
  square.mul_(m_decay).addcmul_(used, used, 1.0 - m_decay);
  slot.parameter.addcdiv_(used, square.sqrt().add_(kEpsilon), -rate);
}

}  // namespace marey

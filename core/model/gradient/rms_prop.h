// RMSProp (Tieleman and Hinton 2012), as PyTorch defines it: the constant that keeps a division
// finite is added to the root, and nothing is centred. Internal (libtorch types).
#pragma once

#include "model/gradient/optimiser.h"

namespace marey {

class RmsProp : public Optimiser {
 public:
  /// `decay`: how much of the mean square of the gradients is kept from step to step.
  RmsProp(const torch::nn::Module& module, double decay);
  const std::vector<std::string>& momentNames() const override;

 private:
  void update(Slot& slot, const torch::Tensor& gradient, double rate, int64_t count,
              const GradientClip& clip) const override;

  double m_decay;
};

}  // namespace marey

// Adam (Kingma and Ba 2015), with the authors' constants. Internal (libtorch types).
#pragma once

#include "model/gradient/optimiser.h"

namespace marey {

class Adam : public Optimiser {
 public:
  explicit Adam(const torch::nn::Module& module, Execution execution = Execution::Engine);
  const std::vector<std::string>& momentNames() const override;

 private:
  void update(Slot& slot, const torch::Tensor& gradient, double rate, int64_t count,
              const GradientClip& clip) const override;

  Execution m_execution;
};

}  // namespace marey

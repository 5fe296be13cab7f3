// One step of training: the gradient of a batch, clipped, and what Adam makes of it.
// Internal (libtorch types).
#pragma once

#include "model/adam.h"
#include "model/trainable.h"
#include "model/training_config.h"
#include "nn/processes/process_group.h"

namespace marey {

struct StepReport {
  double loss = 0.0;          ///< mean over the whole batch, in the objective's unit
  double norm = 0.0;          ///< of the gradient before it is clipped
  std::vector<double> terms;  ///< means of the loss's named parts
  bool taken = false;         ///< false: loss or gradient were not finite, and nothing changed
};

class Optimiser {
 public:
  /// `net` on its device. Every process of the group gives the same batches.
  Optimiser(TrainableModel& net, const TrainingConfig& config, nn::ProcessGroup& group);
  /// `count`: number of this step among those taken, from 1. The gradients stay in place.
  StepReport step(const TrainingBatch& batch, double rate, int64_t count);

  Adam adam;

 private:
  /// Leaves the gradients of this process's share; its part of the mean loss, and of the named
  /// parts after it.
  std::vector<double> gradientsOf(const TrainingBatch& batch);
  void sumOverProcesses(std::vector<double>& losses);
  /// Clips by value and then by norm, as the authors do; returns the norm before.
  double clip(GradientClip& out) const;

  TrainableModel& m_net;
  const TrainingConfig& m_config;
  nn::ProcessGroup& m_group;
};

}  // namespace marey

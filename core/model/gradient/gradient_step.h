// One step of training: the gradient of a batch, clipped, and what the optimiser makes of it.
// Internal (libtorch types).
#pragma once

#include "model/gradient/optimiser.h"
#include "model/gradient/trainable.h"
#include "model/gradient/training_config.h"
#include "nn/processes/process_group.h"

namespace marey {

struct StepReport {
  double loss = 0.0;          ///< mean over the whole batch, in the objective's unit
  double norm = 0.0;          ///< of the gradient before it is clipped
  std::vector<double> terms;  ///< means of the loss's named parts
  bool taken = false;         ///< false: loss or gradient were not finite, and nothing changed
};

class GradientStep {
 public:
  /// `net` on its device. Every process of the group gives the same batches.
  GradientStep(TrainableModel& net, const TrainingConfig& config, nn::ProcessGroup& group);
  /// `count`: number of this step among those taken, from 1. The gradients stay in place.
  StepReport take(const TrainingBatch& batch, double rate, int64_t count);

  Optimiser& optimiser() const { return *m_optimiser; }

 private:
  /// Leaves the gradients of this process's share; its part of the mean loss, and of the named
  /// parts after it.
  std::vector<double> gradientsOf(const TrainingBatch& batch);
  void sumOverProcesses(std::vector<double>& losses);
  /// Clips by value and then by norm, as the authors do; returns the norm before.
  double clip(GradientClip& out) const;

  std::unique_ptr<Optimiser> m_optimiser;
  TrainableModel& m_net;
  const TrainingConfig& m_config;
  nn::ProcessGroup& m_group;
};

}  // namespace marey

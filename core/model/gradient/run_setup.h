// What a training run is given, made ready. Internal (libtorch types).
#pragma once

#include <memory>

#include "model/gradient/trainer.h"
#include "model/gradient/training_data.h"
#include "nn/processes/process_group.h"

namespace marey {

/// Nothing of it changes while the run goes on, but for the net's weights.
struct RunSetup {
  /// Joins the other processes, makes the net on its device and cuts the windows. Throws InputError
  /// and UsageError. The arguments outlive it.
  RunSetup(const DataSet& data, const TrainRequest& request, const ModelFamily& family);

  TrainableModel& net() const { return *trainee.net; }
  bool leads() const { return group->leads(); }
  /// Steps after which the run ends.
  int64_t lastStep() const { return request.steps.value_or(config.steps); }
  double learningRateAt(int64_t step) const;
  /// What a run that goes on must have in common with how it began.
  Json identity() const;

  const DataSet& data;
  const TrainRequest& request;
  const ModelFamily& family;
  TrainingConfig config;
  torch::Device device;
  std::unique_ptr<nn::ProcessGroup> group;
  Trainee trainee;
  Objective objective;
  TrainingData training;
};

}  // namespace marey

// Everything that a training run carries from step to step. Internal (libtorch types).
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "base/json.h"
#include "model/gradient/optimiser.h"
#include "model/gradient/trainable.h"

namespace marey {

struct TrainingState {
  int64_t step = 0;      ///< steps done
  int64_t updates = 0;   ///< steps that were not skipped
  double seconds = 0.0;  ///< of training, earlier runs included
  int nonFinite = 0;     ///< skipped steps in a row
  double bestValid = std::numeric_limits<double>::infinity();  ///< bits per frame
  int64_t snapshots = 0;
  std::map<std::string, torch::Tensor> average;  ///< EMA of the parameters; empty: off
};

/// Atomically. `identity` (data, configuration, seed) must match when resuming.
void saveState(const std::filesystem::path& path, const TrainingState& state,
               const torch::nn::Module& net, const Optimiser& optimiser, const Json& identity);
/// Throws InputError when the file is of another run.
TrainingState loadState(const std::filesystem::path& path, torch::nn::Module& net,
                        Optimiser& optimiser, const Json& identity);

/// Moves the average towards the weights; where there is none, nothing.
void addToAverage(const torch::nn::Module& net, double decay, TrainingState& state);

/// Puts the averaged weights into the net for its lifetime.
class AveragedWeights {
 public:
  AveragedWeights(torch::nn::Module& net, const TrainingState& state);
  ~AveragedWeights();
  AveragedWeights(const AveragedWeights&) = delete;
  AveragedWeights& operator=(const AveragedWeights&) = delete;

 private:
  torch::nn::Module& m_net;
  std::map<std::string, torch::Tensor> m_own;
};

}  // namespace marey

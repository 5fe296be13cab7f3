// Windows of a data set as tensors. The batch of a step is a pure function of (seed, step), so a
// resumed run sees the same batches as an unbroken one. Internal (libtorch types).
#pragma once

#include <vector>

#include "model/data_set.h"
#include "model/gradient/trainable.h"

namespace marey {

class Batches {
 public:
  /// The standardised frames of some sequences on a device, cut into windows.
  Batches(const std::vector<FeatureSequence>& sequences, const Standardiser& standardiser,
          int windowFrames, int hopFrames, torch::Device device);

  /// Leaves controls that may be left out in a share of the windows of every step.
  void hideControl(const FeatureSpec& features, double share);

  int64_t windowCount() const { return static_cast<int64_t>(m_windows.size()); }
  /// The batch of training step `step`: windows in the order of an epoch-wise shuffle.
  TrainingBatch forStep(uint64_t seed, int64_t step, int64_t batch);
  /// Windows [first, first + count) in their own order.
  TrainingBatch inOrder(int64_t first, int64_t count) const;
  TrainingFrames frames(int64_t context, int64_t lookahead) const;

 private:
  /// Columns of a control that may be left out: its values, and its presence.
  struct Hidden {
    int64_t first, width;
  };

  void hide(uint64_t seed, int64_t step, TrainingBatch& batch) const;
  TrainingBatch gather(const std::vector<int64_t>& windows) const;
  void shuffleFor(uint64_t seed, int64_t epoch);

  std::vector<Window> m_windows;
  std::vector<int64_t> m_offsets;  ///< first row of each sequence
  std::vector<int64_t> m_lengths;
  int64_t m_windowFrames;
  torch::Tensor m_pose, m_control;
  std::vector<Hidden> m_hidden;
  double m_hiddenShare = 0.0;
  int64_t m_epoch = -1;
  std::vector<int64_t> m_order;
};

/// Splits off a share of the recorded clips (with all their augmented versions) for validation:
/// every n-th in name order.
std::pair<std::vector<FeatureSequence>, std::vector<FeatureSequence>> splitValidation(
    const std::vector<FeatureSequence>& sequences, double share);

}  // namespace marey

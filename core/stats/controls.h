// The unit of resampling is the control signal (a natural clip's, or a path): motions along one
// control are one cluster, whatever their number and length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace marey::stats {

/// How often each clip and each natural clip is counted; no natural weights: once each.
struct Weights {
  std::vector<double> clips;
  std::vector<double> natural = {};
};

/// How often each of `count` was drawn in `count` draws with replacement, for bootstrap resample
/// `index`; streams are independent.
std::vector<int> resampleWeights(int count, uint64_t seed, uint32_t index, uint32_t stream = 0);

/// A set of clips and natural ones, by the controls that they follow.
class ControlSets {
 public:
  /// The number of every clip's control; both sides in one numbering.
  ControlSets(const std::vector<int>& own, const std::vector<int>& natural);

  size_t ownCount() const { return m_own.size(); }
  size_t naturalCount() const { return m_natural.size(); }

  /// Every control once: a clip counts 1 / (clips of its side along its control), so that more
  /// samples per control do not weigh more.
  Weights once() const;
  /// Controls drawn with replacement: those of both sides together (a pair is drawn as one), those
  /// of one side among themselves.
  Weights drawn(uint64_t seed, uint32_t index) const;
  /// Two independent sets out of the natural clips, of as many controls as either side has: what
  /// two sets of the sizes at hand would be if both were natural. Weights of natural clips only.
  Weights bothNatural(uint64_t seed, uint32_t index) const;

 private:
  using Clips = std::map<int, std::vector<size_t>>;  ///< by control

  Clips m_own, m_natural;
  size_t m_clips = 0, m_naturalClips = 0;
};

/// Numbers for clips without a stated control: each has one of its own, from `first` on.
std::vector<int> controlsEach(size_t clips, int first = 0);

}  // namespace marey::stats

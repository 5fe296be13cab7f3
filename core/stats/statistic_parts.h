// Statistics of sets that are too large to be held: what a set says as a whole, then what each of
// its clips adds. Both are small, can be worked out clip by clip wherever a clip is read, and do
// not depend on how clips are dealt out.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "motion/clip.h"
#include "motion/features.h"

namespace marey {
class Packer;
class Unpacker;
}  // namespace marey

namespace marey::stats {

/// How often values occur: exact up to kExact values, beyond that each to kResolutionM. Counts are
/// whole numbers, so that sums do not depend on their order. Here: heights in metres.
class HeightCounts {
 public:
  static constexpr size_t kExact = 1000000;
  static constexpr double kResolutionM = 1e-5;  ///< the error of a quantile is half of it

  void add(float height);
  void add(const HeightCounts& other);
  /// Linear between order statistics, as sortedQuantile; NaN of none.
  double quantile(double share) const;
  void pack(Packer& packer) const;
  static HeightCounts unpacked(Unpacker& bytes);

 private:
  void coarsen();

  std::vector<float> m_exact;
  std::map<int64_t, int64_t> m_counts;  ///< by height in steps of kResolutionM, where not exact
};

/// A set of clips as a whole.
struct SetFacts {
  size_t clips = 0;
  double frames = 0.0;
  bool moves = false;                     ///< a clip has two frames
  std::vector<double> boneLengthSums;     ///< over frames, of Skeleton::bones(), metres
  std::vector<HeightCounts> footHeights;  ///< of every foot of the analysis

  /// Clips must be added in order where the last bits of sums matter.
  void add(const SetFacts& other);
  std::vector<double> meanBoneLengths() const;
  /// Of every foot: the 5th percentile of its heights.
  std::vector<double> standingHeights() const;
  void pack(Packer& packer) const;
  static SetFacts unpacked(Unpacker& bytes);
};
SetFacts factsOf(const Clip& clip, const std::vector<int>& feet);

/// What statistics know before they see clips.
struct StatisticSetting {
  std::shared_ptr<const Skeleton> skeleton;  ///< of the first clip
  std::vector<int> feet;     ///< joints of footstep and skate analysis; empty: none of these
  std::vector<int> toes;     ///< joints of rules about toes
  double footStepCmS = 1.0;  ///< increment of the footstep tolerance
  std::vector<int> controls, naturalControls;  ///< of every clip, as in StatisticInput
  SetFacts own;
  const SetFacts* natural = nullptr;  ///< null where there is no natural motion
  /// Wanted root trajectory of every clip, at the clip's rate; null where there is none.
  const std::vector<std::vector<RootFrame>>* wanted = nullptr;
  /// Of every foot and bone, in metres: of natural motion, else of the clips themselves.
  std::vector<double> standingHeights, meanBoneLengths;

  /// Works out what was left empty (controls, toes) and the references, once for all clips.
  void completeReferences();
  /// The setting of the natural motion, which is then its own natural motion.
  StatisticSetting ofNatural() const;
};

/// What one clip adds to a statistic, packed; what is in it is up to its rule.
using ClipPart = std::string;
/// The parts of a set, by rule and clip.
using SetParts = std::vector<std::vector<ClipPart>>;

}  // namespace marey::stats

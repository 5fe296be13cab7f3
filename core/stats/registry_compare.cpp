// Statistics that compare per-joint distributions with those of natural motion.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/packing.h"
#include "motion/roles.h"
#include "stats/joint_samples.h"
#include "stats/sample_distance.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

/// Frames of a set that enter a distribution; beyond it every k-th frame does.
constexpr double kFrameLimit = 5000.0;

/// A set with more frames takes other frames of every clip: with a stride beyond the length of
/// clips only their first ones would count.
constexpr double kLongSet = 100000.0;

/// The samples of every quantity and joint, one after the other.
ClipPart samplesPart(const Clip& clip, size_t index, const SetFacts& set,
                     const std::vector<Quantity>& quantities) {
  const int stride = std::max(1, static_cast<int>(std::ceil(set.frames / kFrameLimit)));
  const int phase =
      set.frames > kLongSet ? static_cast<int>(index % static_cast<size_t>(stride)) : 0;
  Packer packer;
  bool some = false;
  for (const Quantity quantity : quantities)
    for (const auto& samples : jointSamples(clip, quantity, stride, phase)) {
      packer.add(samples);
      some = some || !samples.empty();
    }
  return some ? packer.take() : ClipPart();
}

/// samples[quantity and joint][clip]
std::vector<std::vector<std::vector<double>>> samplesByJoint(const std::vector<ClipPart>& parts,
                                                             size_t lists) {
  std::vector<std::vector<std::vector<double>>> out(lists);
  for (const ClipPart& part : parts) {
    Unpacker bytes(part);
    for (auto& list : out)
      list.push_back(part.empty() ? std::vector<double>() : bytes.list<double>());
  }
  return out;
}

bool hasValues(const std::vector<std::vector<double>>& samples) {
  return std::any_of(samples.begin(), samples.end(), [](const auto& s) { return !s.empty(); });
}

/// Mean over joints (and quantities) of a distance to natural motion.
WeightedValue distance(const std::vector<ClipPart>& ownParts,
                       const std::vector<ClipPart>& naturalParts, size_t lists,
                       double SampleDistance::*which) {
  auto pools = std::make_shared<std::vector<PooledSamples>>();
  const auto own = samplesByJoint(ownParts, lists);
  const auto natural = samplesByJoint(naturalParts, lists);
  for (size_t j = 0; j < own.size(); ++j)
    if (hasValues(own[j]) && hasValues(natural[j])) pools->emplace_back(own[j], natural[j]);
  return [pools, which](const Weights& weights) {
    double sum = 0.0;
    for (const PooledSamples& pool : *pools)
      sum += pool.distance(weights.clips, weights.natural).*which;
    return sum / static_cast<double>(pools->size());
  };
}

bool hasNatural(const StatisticSetting& setting) {
  return setting.natural && setting.natural->moves && setting.own.moves;
}

bool hasNaturalAndHips(const StatisticSetting& setting) {
  return hasNatural(setting) && rolesOf(*setting.skeleton).hasFacing();
}

void addPair(std::vector<Statistic>& list, const std::string& what, const std::string& text,
             const std::string& unit, const std::vector<Quantity>& quantities) {
  const bool needsHips = quantities.front() == Quantity::Sideways;
  const auto applies = needsHips ? hasNaturalAndHips : hasNatural;
  const auto rule = std::make_shared<const PartRule>(
      PartRule{[quantities](const Clip& clip, size_t index, const StatisticSetting& setting) {
        return samplesPart(clip, index, setting.own, quantities);
      }});
  const auto by = [count = quantities.size()](double SampleDistance::*which) {
    return [count, which](const std::vector<ClipPart>& own, const std::vector<ClipPart>& natural,
                          const StatisticSetting& setting) {
      const auto joints = static_cast<size_t>(setting.skeleton->jointCount());
      return distance(own, natural, count * joints, which);
    };
  };
  list.push_back(
      {what + "_wasserstein", unit,
       "1-Wasserstein distance between the distributions of " + text +
           " in the clips and in natural motion, mean over joints (of long sets every k-th frame, "
           "about 5,000 in all).",
       "Ramdas, Garcia Trillos, Cuturi 2017", true, applies, rule,
       by(&SampleDistance::wasserstein)});
  list.push_back(
      {what + "_ks", "",
       "Kolmogorov-Smirnov statistic between the distributions of " + text +
           " in the clips and in natural motion, mean over joints (of long sets every k-th frame, "
           "about 5,000 in all).",
       "Smirnov 1948", true, applies, rule, by(&SampleDistance::kolmogorov)});
}

}  // namespace

std::vector<Statistic> comparisonStatistics() {
  std::vector<Statistic> list;
  addPair(list, "joint_speed", "joint speed", "cm/s", {Quantity::Speed});
  addPair(list, "joint_height", "joint height", "cm", {Quantity::Height});
  addPair(list, "joint_position", "joint position about the root (sideways and forward)", "cm",
          {Quantity::Sideways, Quantity::Forward});
  addPair(list, "joint_angle", "the bend at the joint", "deg", {Quantity::Angle});
  return list;
}

}  // namespace marey::stats

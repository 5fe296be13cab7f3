// Statistics that compare per-joint distributions with those of natural motion.
#include <algorithm>
#include <cmath>
#include <memory>

#include "motion/roles.h"
#include "stats/joint_samples.h"
#include "stats/sample_distance.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

/// Frames of a set that enter a distribution; beyond it every k-th frame does.
constexpr double kFrameLimit = 5000.0;

int strideFor(const std::vector<Clip>& clips) {
  double frames = 0.0;
  for (const Clip& clip : clips) frames += clip.frameCount();
  return std::max(1, static_cast<int>(std::ceil(frames / kFrameLimit)));
}

/// samples[joint][clip]
std::vector<std::vector<std::vector<double>>> samplesByJoint(const std::vector<Clip>& clips,
                                                             Quantity quantity) {
  const int stride = strideFor(clips);
  std::vector<std::vector<std::vector<double>>> out(clips.front().jointCount());
  for (const Clip& clip : clips) {
    auto samples = jointSamples(clip, quantity, stride);
    for (size_t j = 0; j < samples.size(); ++j) out[j].push_back(std::move(samples[j]));
  }
  return out;
}

bool hasValues(const std::vector<std::vector<double>>& samples) {
  return std::any_of(samples.begin(), samples.end(), [](const auto& s) { return !s.empty(); });
}

/// Mean over joints (and quantities) of a distance to natural motion.
WeightedValue distance(const StatisticInput& input, const std::vector<Quantity>& quantities,
                       double SampleDistance::*which) {
  auto pools = std::make_shared<std::vector<PooledSamples>>();
  for (Quantity quantity : quantities) {
    const auto own = samplesByJoint(*input.clips, quantity);
    const auto natural = samplesByJoint(*input.natural, quantity);
    for (size_t j = 0; j < own.size(); ++j)
      if (hasValues(own[j]) && hasValues(natural[j])) pools->emplace_back(own[j], natural[j]);
  }
  return [pools, which](const Weights& weights) {
    double sum = 0.0;
    for (const PooledSamples& pool : *pools)
      sum += pool.distance(weights.clips, weights.natural).*which;
    return sum / static_cast<double>(pools->size());
  };
}

bool canMove(const std::vector<Clip>& clips) {
  return std::any_of(clips.begin(), clips.end(), [](const Clip& c) { return c.frameCount() > 1; });
}

bool hasNatural(const StatisticInput& input) {
  return input.natural && !input.natural->empty() && canMove(*input.natural) &&
         canMove(*input.clips);
}

bool hasNaturalAndHips(const StatisticInput& input) {
  return hasNatural(input) && rolesOf(*input.clips->front().skeleton).hasFacing();
}

void addPair(std::vector<Statistic>& list, const std::string& what, const std::string& text,
             const std::string& unit, const std::vector<Quantity>& quantities) {
  const bool needsHips = quantities.front() == Quantity::Sideways;
  const auto applies = needsHips ? hasNaturalAndHips : hasNatural;
  list.push_back(
      {what + "_wasserstein", unit,
       "1-Wasserstein distance between the distributions of " + text +
           " in the clips and in natural motion, mean over joints (of long sets every k-th frame, "
           "about 5,000 in all).",
       "Ramdas, Garcia Trillos, Cuturi 2017", true, applies, [quantities](const auto& input) {
         return distance(input, quantities, &SampleDistance::wasserstein);
       }});
  list.push_back(
      {what + "_ks", "",
       "Kolmogorov-Smirnov statistic between the distributions of " + text +
           " in the clips and in natural motion, mean over joints (of long sets every k-th frame, "
           "about 5,000 in all).",
       "Smirnov 1948", true, applies, [quantities](const auto& input) {
         return distance(input, quantities, &SampleDistance::kolmogorov);
       }});
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

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/error.h"
#include "motion/roles.h"
#include "stats/bones.h"
#include "stats/diversity.h"
#include "stats/statistic.h"
#include "stats/trajectories.h"
#include "stats/weighted.h"

namespace marey::stats {
namespace {

/// Clips whose pairs are compared for diversity: 19,900 pairs.
constexpr int kDiversityClips = 200;

bool always(const StatisticInput&) {
  return true;
}

bool hasBones(const StatisticInput& input) {
  return input.clips->front().jointCount() > 1;
}

/// Reference lengths of a clip: of natural motion, else of its own skeleton; a skeleton without
/// offsets (positions only) gives none, and the mean of the clips serves.
std::function<std::vector<double>(const Clip&)> boneReference(const StatisticInput& input) {
  const auto rest = skeletonBoneLengths(*input.clips->front().skeleton);
  const bool known = std::any_of(rest.begin(), rest.end(), [](double m) { return m > 0.0; });
  if (!input.natural && known)
    return [](const Clip& clip) { return skeletonBoneLengths(*clip.skeleton); };
  auto mean = meanBoneLengths(input.natural ? *input.natural : *input.clips);
  return [mean = std::move(mean)](const Clip&) { return std::vector<double>(mean); };
}

WeightedValue boneError(const StatisticInput& input) {
  const auto reference = boneReference(input);
  return weightedRatio(
      *input.clips,
      [&](const Clip& clip) {
        const auto lengths = reference(clip);
        return RatioPart{squaredBoneError(clip, lengths), static_cast<double>(clip.frameCount()) *
                                                              static_cast<double>(lengths.size())};
      },
      [](double square) { return 100.0 * std::sqrt(square); });
}

WeightedValue meanJerk(const StatisticInput& input) {
  return weightedRatio(*input.clips, [](const Clip& clip) {
    const JerkTally tally = jerk(clip);
    return RatioPart{tally.sum, tally.count};
  });
}

bool canBeDiverse(const StatisticInput& input) {
  return input.clips->size() > 1 && rolesOf(*input.clips->front().skeleton).hasFacing();
}

WeightedValue diversity(const StatisticInput& input) {
  const auto kept = spreadIndices(static_cast<int>(input.clips->size()), kDiversityClips);
  std::vector<Clip> clips;
  clips.reserve(kept.size());
  for (int i : kept) clips.push_back((*input.clips)[i]);
  auto distances = std::make_shared<const std::vector<double>>(pairDistances(clips));
  return [=](const Weights& weights) {
    std::vector<int> own;
    own.reserve(kept.size());
    for (int i : kept) own.push_back(weights.clips[i]);
    return 100.0 * meanPairDistance(*distances, own);
  };
}

bool hasWanted(const StatisticInput& input) {
  return input.wanted && rolesOf(*input.clips->front().skeleton).hasFacing();
}

WeightedValue meanPathError(const StatisticInput& input) {
  std::vector<double> errors;
  for (size_t i = 0; i < input.clips->size(); ++i) {
    const Clip& clip = (*input.clips)[i];
    FeatureSpec spec;
    spec.fps = clip.fps;
    errors.push_back(100.0 * pathError(rootTrajectory(clip, spec), (*input.wanted)[i]).meanM);
  }
  return [errors](const Weights& weights) {
    double sum = 0.0;
    double count = 0.0;
    for (size_t i = 0; i < errors.size(); ++i) {
      sum += weights.clips[i] * errors[i];
      count += weights.clips[i];
    }
    return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  };
}

std::vector<Statistic> bodyStatistics() {
  return {
      {"bone_length_rmse", "cm",
       "Root mean square deviation of bone lengths over bones and frames from their reference: the "
       "mean of natural motion, else the clip's skeleton.",
       "Henter, Alexanderson, Beskow 2020 (MoGlow), Sec. 5.3", false, hasBones, boneError},
      {"jerk", "m/s^3", "Mean norm of the third derivative of joint positions, per second.",
       "Flash and Hogan 1985", false, always, meanJerk},
      {"diversity", "cm",
       "Mean over pairs of clips and equal times of the root mean square joint distance in the "
       "root frame.",
       "Yuan and Kitani 2020 (DLow, average pairwise distance), in the root frame", false,
       canBeDiverse, diversity},
      {"path_error", "cm",
       "Mean floor distance of the root trajectory from the wanted one, mean over clips.", "Marey",
       false, hasWanted, meanPathError},
  };
}

std::vector<Statistic> buildRegistry() {
  std::vector<Statistic> list = footStatistics();
  for (const auto& part : {bodyStatistics(), comparisonStatistics()})
    list.insert(list.end(), part.begin(), part.end());
  return list;
}

}  // namespace

WeightedValue weightedRatio(const std::vector<Clip>& clips,
                            const std::function<RatioPart(const Clip&)>& part,
                            const std::function<double(double)>& finish) {
  std::vector<RatioPart> parts;
  parts.reserve(clips.size());
  for (const Clip& clip : clips) parts.push_back(part(clip));
  return [parts, finish](const Weights& weights) {
    double sum = 0.0;
    double count = 0.0;
    for (size_t i = 0; i < parts.size(); ++i) {
      sum += weights.clips[i] * parts[i].sum;
      count += weights.clips[i] * parts[i].count;
    }
    if (count == 0.0) return std::numeric_limits<double>::quiet_NaN();
    return finish ? finish(sum / count) : sum / count;
  };
}

const std::vector<Statistic>& allStatistics() {
  static const std::vector<Statistic> list = buildRegistry();
  return list;
}

const Statistic& statisticByName(const std::string& name) {
  std::string known;
  for (const Statistic& statistic : allStatistics()) {
    if (statistic.name == name) return statistic;
    known += (known.empty() ? "" : ", ") + statistic.name;
  }
  throw UsageError("there is no statistic '" + name + "'; known statistics: " + known);
}

}  // namespace marey::stats

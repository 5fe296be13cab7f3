#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/packing.h"
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

bool always(const StatisticSetting&) {
  return true;
}

bool hasBones(const StatisticSetting& setting) {
  return setting.skeleton->jointCount() > 1;
}

/// Reference lengths of a clip: of natural motion, else of its own skeleton; a skeleton without
/// offsets (positions only) gives none, and the mean of the clips serves.
std::vector<double> boneReference(const Clip& clip, const StatisticSetting& setting) {
  const auto rest = skeletonBoneLengths(*setting.skeleton);
  const bool known = std::any_of(rest.begin(), rest.end(), [](double m) { return m > 0.0; });
  if (!setting.natural && known) return skeletonBoneLengths(*clip.skeleton);
  return setting.meanBoneLengths;
}

RatioPart boneError(const Clip& clip, size_t, const StatisticSetting& setting) {
  const auto lengths = boneReference(clip, setting);
  return {squaredBoneError(clip, lengths),
          static_cast<double>(clip.frameCount()) * static_cast<double>(lengths.size())};
}

RatioPart jerkPart(const Clip& clip, size_t, const StatisticSetting&) {
  const JerkTally tally = jerk(clip);
  return {tally.sum, tally.count};
}

bool canBeDiverse(const StatisticSetting& setting) {
  return setting.own.clips > 1 && rolesOf(*setting.skeleton).hasFacing();
}

std::vector<int> diverseClips(const StatisticSetting& setting) {
  return spreadIndices(static_cast<int>(setting.own.clips), kDiversityClips);
}

/// Poses of the clips that pairs are made of.
ClipPart posesPart(const Clip& clip, size_t index, const StatisticSetting& setting) {
  const auto kept = diverseClips(setting);
  if (!std::binary_search(kept.begin(), kept.end(), static_cast<int>(index))) return {};
  const Matrix poses = rootFramePoses(clip);
  Packer packer;
  packer.add(static_cast<long>(poses.rows()))
      .add(std::span<const float>(poses.data(), static_cast<size_t>(poses.size())));
  return packer.take();
}

WeightedValue diversity(const std::vector<ClipPart>& parts, const std::vector<ClipPart>&,
                        const StatisticSetting& setting) {
  const auto kept = diverseClips(setting);
  std::vector<Matrix> poses;
  for (const int i : kept) {
    Unpacker bytes(parts[static_cast<size_t>(i)]);
    const long rows = bytes.number<long>();
    const auto values = bytes.list<float>();
    poses.emplace_back(Eigen::Map<const Matrix>(
        values.data(), rows, static_cast<long>(values.size()) / std::max(1L, rows)));
  }
  auto distances = std::make_shared<const std::vector<double>>(pairDistances(poses));
  return [=](const Weights& weights) {
    std::vector<int> own;
    own.reserve(kept.size());
    for (int i : kept) own.push_back(weights.clips[i]);
    return 100.0 * meanPairDistance(*distances, own);
  };
}

bool hasWanted(const StatisticSetting& setting) {
  return setting.wanted && rolesOf(*setting.skeleton).hasFacing();
}

/// A mean over clips, whatever their length.
RatioPart pathErrorPart(const Clip& clip, size_t index, const StatisticSetting& setting) {
  FeatureSpec spec;
  spec.fps = clip.fps;
  return {100.0 * pathError(rootTrajectory(clip, spec), (*setting.wanted)[index]).meanM, 1.0};
}

std::vector<Statistic> bodyStatistics() {
  return {
      {"bone_length_rmse", "cm",
       "Root mean square deviation of bone lengths over bones and frames from their reference: the "
       "mean of natural motion, else the clip's skeleton.",
       "Henter, Alexanderson, Beskow 2020 (MoGlow), Sec. 5.3", false, hasBones,
       ratioRule(boneError), combineRatio([](double square) { return 100.0 * std::sqrt(square); })},
      {"jerk", "m/s^3", "Mean norm of the third derivative of joint positions, per second.",
       "Flash and Hogan 1985", false, always, ratioRule(jerkPart), combineRatio()},
      {"diversity", "cm",
       "Mean over pairs of clips and equal times of the root mean square joint distance in the "
       "root frame (of more than 200 clips 200, evenly spread).",
       "Yuan and Kitani 2020 (DLow, average pairwise distance), in the root frame", false,
       canBeDiverse, std::make_shared<const PartRule>(PartRule{posesPart}), diversity},
      {"path_error", "cm",
       "Mean floor distance of the root trajectory from the wanted one, mean over clips.", "Marey",
       false, hasWanted, ratioRule(pathErrorPart), combineRatio()},
  };
}

std::vector<Statistic> buildRegistry() {
  std::vector<Statistic> list = footStatistics();
  for (const auto& part : {bodyStatistics(), comparisonStatistics()})
    list.insert(list.end(), part.begin(), part.end());
  return list;
}

}  // namespace

std::shared_ptr<const PartRule> ratioRule(
    std::function<RatioPart(const Clip&, size_t, const StatisticSetting&)> part) {
  return std::make_shared<const PartRule>(PartRule{
      [part = std::move(part)](const Clip& clip, size_t index, const StatisticSetting& setting) {
        const RatioPart ratio = part(clip, index, setting);
        Packer packer;
        packer.add(ratio.sum).add(ratio.count);
        return packer.take();
      }});
}

WeightedValue weightedRatio(const std::vector<ClipPart>& packed,
                            const std::function<double(double)>& finish) {
  std::vector<RatioPart> parts;
  parts.reserve(packed.size());
  for (const ClipPart& part : packed) {
    Unpacker bytes(part);
    const double sum = bytes.number<double>();
    parts.push_back({sum, bytes.number<double>()});
  }
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

std::function<WeightedValue(const std::vector<ClipPart>&, const std::vector<ClipPart>&,
                            const StatisticSetting&)>
combineRatio(std::function<double(double)> finish) {
  return
      [finish = std::move(finish)](const std::vector<ClipPart>& own, const std::vector<ClipPart>&,
                                   const StatisticSetting&) { return weightedRatio(own, finish); };
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

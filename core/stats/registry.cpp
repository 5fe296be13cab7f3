#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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

/// Clips by control, of controls with several: those that pairs are made of.
std::map<int, std::vector<size_t>> diverseClips(const StatisticSetting& setting) {
  std::map<int, std::vector<size_t>> out;
  for (size_t i = 0; i < setting.controls.size(); ++i) out[setting.controls[i]].push_back(i);
  std::erase_if(out, [](const auto& group) { return group.second.size() < 2; });
  for (auto& [control, clips] : out) {
    std::vector<size_t> kept;
    for (const int i : spreadIndices(static_cast<int>(clips.size()), kDiversityMotions))
      kept.push_back(clips[static_cast<size_t>(i)]);
    clips = std::move(kept);
  }
  return out;
}

bool canBeDiverse(const StatisticSetting& setting) {
  return rolesOf(*setting.skeleton).hasFacing() && !diverseClips(setting).empty();
}

/// Poses of a clip that shares its control with others; nothing of one that is alone.
ClipPart posesPart(const Clip& clip, size_t index, const StatisticSetting& setting) {
  const int control = setting.controls[index];
  if (std::count(setting.controls.begin(), setting.controls.end(), control) < 2) return {};
  const Matrix poses = rootFramePoses(clip);
  Packer packer;
  packer.add(static_cast<long>(poses.rows()))
      .add(std::span<const float>(poses.data(), static_cast<size_t>(poses.size())));
  return packer.take();
}

Matrix posesOf(const ClipPart& part) {
  Unpacker bytes(part);
  const long rows = bytes.number<long>();
  const auto values = bytes.list<float>();
  return Eigen::Map<const Matrix>(values.data(), rows,
                                  static_cast<long>(values.size()) / std::max(1L, rows));
}

/// The mean over controls of the diversity along each.
WeightedValue diversity(const std::vector<ClipPart>& parts, const std::vector<ClipPart>&,
                        const StatisticSetting& setting) {
  struct Along {
    double valueM;
    std::vector<size_t> clips;
  };
  std::vector<Along> controls;
  for (auto& [control, clips] : diverseClips(setting)) {
    std::vector<Matrix> poses;
    for (const size_t clip : clips) poses.push_back(posesOf(parts[clip]));
    const PairCurve curve = pairCurve(poses);
    if (!curve.pairs.empty()) controls.push_back({curve.meanM(0, curve.pairs.size()), clips});
  }
  return [controls](const Weights& weights) {
    double sum = 0.0;
    double count = 0.0;
    for (const Along& along : controls) {
      double weight = 0.0;
      for (const size_t clip : along.clips) weight += weights.clips[clip];
      sum += weight * along.valueM;
      count += weight;
    }
    return count > 0.0 ? 100.0 * sum / count : std::numeric_limits<double>::quiet_NaN();
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
       "mean of natural motion, else the clip's skeleton, else the mean of the clips.",
       "Henter, Alexanderson, Beskow 2020, Sec. 5.3; the choice of reference is Marey's",
       false, hasBones, ratioRule(boneError),
       combineRatio([](double square) { return 100.0 * std::sqrt(square); })},
      {"jerk", "m/s^3",
       "Mean over joints and frames of the Euclidean norm of the third difference of the position, "
       "times the rate cubed.",
       "Marey; the third derivative as in Flash and Hogan 1985. Not the jerk of FlowMDM, which is "
       "per frame, an L1 norm and a maximum over joints",
       false, always, ratioRule(jerkPart), combineRatio()},
      {"diversity", "cm",
       "Mean over pairs of motions along the same control, over frames (equal time from the start) "
       "and then over controls, of the root mean square joint distance in the root frame (of more "
       "than 48 motions along one control 48, evenly spread).",
       "Marey; after the average pairwise distance of Yuan and Kitani 2020 (DLow), which takes one "
       "norm over the whole sequence",
       false, canBeDiverse, std::make_shared<const PartRule>(PartRule{posesPart}), diversity},
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
        if (ratio.count == 0.0) return ClipPart();
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
    if (part.empty()) {
      parts.push_back({});
      continue;
    }
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

// Statistics of feet: footsteps by tolerance, skate and contact.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/packing.h"
#include "stats/displacements.h"
#include "stats/footsteps.h"
#include "stats/sample_distance.h"
#include "stats/skate.h"
#include "stats/statistic.h"
#include "stats/weighted.h"

namespace marey::stats {
namespace {

const char* const kHenter = "Henter, Alexanderson, Beskow 2020, Sec. 5.3";
const char* const kOfHentersSteps =
    "Marey, of the steps of Henter, Alexanderson, Beskow 2020, Sec. 5.3";

/// Foot speeds that enter a median; of longer sets every k-th frame does.
constexpr double kSpeedLimit = 1e6;

bool hasFeet(const StatisticSetting& setting) {
  return !setting.feet.empty();
}

FootstepOptions optionsOf(const StatisticSetting& setting) {
  return {.feet = setting.feet, .stepCmS = setting.footStepCmS};
}

/// Of a clip of one frame, which has no speed, nothing.
ClipPart tallyPart(const Clip& clip, size_t, const StatisticSetting& setting) {
  if (clip.frameCount() < 2) return {};
  const FootstepTally tally = footstepTally(clip, optionsOf(setting));
  Packer packer;
  packer.add(tally.lengthS).add(tally.count).add(tally.seconds).add(tally.squaredSeconds);
  return packer.take();
}

/// A number read off the footstep curve.
using CurveReader = double (*)(const FootstepCurve& curve);

WeightedValue fromCurve(const std::vector<ClipPart>& parts, const StatisticSetting& setting,
                        CurveReader read) {
  const auto tolerances = footstepTolerances(optionsOf(setting));
  auto tallies = std::make_shared<const std::vector<FootstepTally>>(footstepTallies(parts));
  return [=](const Weights& weights) {
    const FootstepCurve curve = curveOf(tolerances, *tallies, weights.clips);
    return curve.maxCount > 0.0 ? read(curve) : std::numeric_limits<double>::quiet_NaN();
  };
}

Statistic footstep(const std::string& name, const std::string& unit, const std::string& definition,
                   CurveReader read, const char* source = kHenter) {
  return {.name = name,
          .unit = unit,
          .definition = definition,
          .source = source,
          .comparison = false,
          .applies = hasFeet,
          .rule = footstepRule(),
          .combine = [read](const auto& own, const auto&, const StatisticSetting& setting) {
            return fromCurve(own, setting, read);
          }};
}

RatioPart partOf(const SkateTally& tally) {
  return {tally.sum, tally.frames};
}

/// How high the feet stand is told by natural motion where there is some.
RatioPart weightedSkate(const Clip& clip, size_t, const StatisticSetting& setting) {
  return partOf(heightWeightedSkate(clip, setting.feet, setting.standingHeights));
}

RatioPart skates(const Clip& clip, size_t, const StatisticSetting& setting) {
  return partOf(skatingShare(clip, setting.toes));
}

RatioPart displaced(const Clip& clip, size_t, const StatisticSetting& setting) {
  double count = 0.0;
  for (const int foot : setting.feet) count += displacements(clip, foot);
  return {count, clip.seconds()};
}

RatioPart contact(const Clip& clip, size_t, const StatisticSetting& setting) {
  return partOf(contactShare(clip, setting.feet));
}

double percent(double share) {
  return 100.0 * share;
}

ClipPart speedsPart(const Clip& clip, size_t index, const StatisticSetting& setting) {
  const double all = setting.own.frames * static_cast<double>(setting.feet.size());
  const auto stride = static_cast<size_t>(std::max(1.0, std::ceil(all / kSpeedLimit)));
  std::vector<double> kept;
  for (const int foot : setting.feet) {
    const auto speeds = horizontalSpeedsCmS(clip, foot);
    for (size_t i = index % stride; i < speeds.size(); i += stride) kept.push_back(speeds[i]);
  }
  if (kept.empty()) return {};
  Packer packer;
  packer.add(kept);
  return packer.take();
}

/// The weighted median of the horizontal foot speeds.
WeightedValue medianSpeed(const std::vector<ClipPart>& parts, const std::vector<ClipPart>&,
                          const StatisticSetting&) {
  auto values = std::make_shared<std::vector<std::pair<double, size_t>>>();
  for (size_t i = 0; i < parts.size(); ++i)
    if (!parts[i].empty())
      for (const double speed : Unpacker(parts[i]).list<double>()) values->emplace_back(speed, i);
  std::sort(values->begin(), values->end());
  return [values](const Weights& weights) {
    double total = 0.0;
    for (const auto& [speed, clip] : *values) total += weights.clips[clip];
    double below = 0.0;
    for (const auto& [speed, clip] : *values)
      if ((below += weights.clips[clip]) >= 0.5 * total && total > 0.0) return speed;
    return std::numeric_limits<double>::quiet_NaN();
  };
}

std::vector<Statistic> footsteps() {
  return {
      footstep("footstep_v95", "cm/s",
               "First speed tolerance v with at least 95 % of the largest footstep count; a sharp "
               "foot contact has a low one.",
               [](const FootstepCurve& c) { return c.v95CmS; }),
      footstep(
          "footstep_rate", "1/s", "Footsteps f(v95), of all feet, per second of motion.",
          [](const FootstepCurve& c) { return c.stepsPerS; }, kOfHentersSteps),
      footstep("footstep_duration", "s", "Mean duration of the footsteps at v95.",
               [](const FootstepCurve& c) { return c.durationMeanS; }),
      footstep("footstep_duration_sd", "s",
               "Population standard deviation of the durations of the footsteps at v95.",
               [](const FootstepCurve& c) { return c.durationStdS; }),
  };
}

}  // namespace

std::shared_ptr<const PartRule> footstepRule() {
  static const auto rule = std::make_shared<const PartRule>(PartRule{tallyPart});
  return rule;
}

std::vector<FootstepTally> footstepTallies(const std::vector<ClipPart>& parts) {
  std::vector<FootstepTally> out;
  for (const ClipPart& part : parts) {
    FootstepTally& tally = out.emplace_back();
    if (part.empty()) continue;
    Unpacker bytes(part);
    tally.lengthS = bytes.number<double>();
    for (auto* list : {&tally.count, &tally.seconds, &tally.squaredSeconds})
      *list = bytes.list<double>();
  }
  return out;
}

std::vector<Statistic> footStatistics() {
  std::vector<Statistic> list = footsteps();
  list.push_back({"foot_speed_median", "cm/s",
                  "Median horizontal speed of the feet over frames "
                  "(of long sets every k-th frame, about 1,000,000 in all).",
                  "Marey", false, hasFeet, std::make_shared<const PartRule>(PartRule{speedsPart}),
                  medianSpeed});
  list.push_back(
      {"foot_displacement_rate", "1/s",
       "Displacements of a foot of more than 3 cm between rests, per second of motion; a "
       "foot rests once it has kept within 1 cm for 0.2 s and leaves its rest beyond 3 "
       "cm, so that jitter is no step.",
       "Marey", false, hasFeet, ratioRule(displaced), combineRatio()});
  list.push_back(
      {"foot_skate_height_weighted", "cm/s",
       "Mean of v (2 - 2^(h/H)), H = 2.5 cm, over feet and frames; 0 where h > H. v: horizontal "
       "speed, h: height above the 5th percentile of the foot's (natural) heights.",
       "Marey, after Zhang et al. 2018 (MANN), which takes the toes' height itself", false, hasFeet,
       ratioRule(weightedSkate), combineRatio()});
  list.push_back(
      {"foot_skate_share", "%",
       "Share of frames in which some toe is below 5 cm now and in the frame before and "
       "faster over the floor than 50 cm/s, now and in the mean of the 5 frames about it "
       "(zeros beyond the ends); published at 20 fps. Toes: those of the skeleton, or "
       "the feet where joints were chosen.",
       "Karunratanakul et al. 2023 (Guided Motion Diffusion), skating ratio of its code "
       "(2f6264a)",
       false, hasFeet, ratioRule(skates), combineRatio(percent)});
  list.push_back({"foot_contact_share", "%",
                  "Share of feet and frames in contact: squared displacement in 1/30 s below 0.02 "
                  "cm^2, that is slower than 4.24 cm/s.",
                  "Marey, by the contact test of Harvey et al. 2020 (LaFAN1), whose code labels "
                  "frames and repeats the last one",
                  false, hasFeet, ratioRule(contact), combineRatio(percent)});
  return list;
}

}  // namespace marey::stats

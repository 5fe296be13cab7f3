// Statistics of feet: footsteps by tolerance, skate and contact.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/packing.h"
#include "stats/footsteps.h"
#include "stats/sample_distance.h"
#include "stats/skate.h"
#include "stats/statistic.h"
#include "stats/weighted.h"

namespace marey::stats {
namespace {

const char* const kMoGlow = "Henter, Alexanderson, Beskow 2020 (MoGlow), Sec. 5.3";

/// Foot speeds that enter a median; of longer sets every k-th frame does.
constexpr double kSpeedLimit = 1e6;

bool hasFeet(const StatisticSetting& setting) {
  return !setting.feet.empty();
}

FootstepOptions optionsOf(const StatisticSetting& setting) {
  return {.feet = setting.feet, .stepCmS = setting.footStepCmS};
}

ClipPart tallyPart(const Clip& clip, size_t, const StatisticSetting& setting) {
  const FootstepTally tally = footstepTally(clip, optionsOf(setting));
  Packer packer;
  packer.add(clip.seconds()).add(tally.count).add(tally.seconds).add(tally.squaredSeconds);
  return packer.take();
}

/// A number read off the footstep curve; `seconds` is the weighted length of the clips.
using CurveReader = double (*)(const FootstepCurve& curve, double seconds);

WeightedValue fromCurve(const std::vector<ClipPart>& parts, const StatisticSetting& setting,
                        CurveReader read) {
  const auto tolerances = footstepTolerances(optionsOf(setting));
  auto tallies = std::make_shared<const std::vector<FootstepTally>>(footstepTallies(parts));
  std::vector<double> seconds;
  for (const ClipPart& part : parts) seconds.push_back(Unpacker(part).number<double>());
  return [=](const Weights& weights) {
    double total = 0.0;
    for (size_t i = 0; i < weights.clips.size(); ++i) total += weights.clips[i] * seconds[i];
    const FootstepCurve curve = curveOf(tolerances, *tallies, weights.clips);
    return curve.maxCount > 0 ? read(curve, total) : std::numeric_limits<double>::quiet_NaN();
  };
}

Statistic footstep(const std::string& name, const std::string& unit, const std::string& definition,
                   CurveReader read) {
  return {.name = name,
          .unit = unit,
          .definition = definition,
          .source = kMoGlow,
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

/// A rule that needs to know how high the feet stand: by natural motion where there is some.
using SkateRule = SkateTally (*)(const Clip&, const std::vector<int>&, const std::vector<double>&);

std::shared_ptr<const PartRule> skate(SkateRule rule) {
  return ratioRule([rule](const Clip& clip, size_t, const StatisticSetting& setting) {
    return partOf(rule(clip, setting.feet, setting.standingHeights));
  });
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
  Packer packer;
  packer.add(kept);
  return packer.take();
}

/// The weighted median of the horizontal foot speeds.
WeightedValue medianSpeed(const std::vector<ClipPart>& parts, const std::vector<ClipPart>&,
                          const StatisticSetting&) {
  auto values = std::make_shared<std::vector<std::pair<double, size_t>>>();
  for (size_t i = 0; i < parts.size(); ++i)
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
               [](const FootstepCurve& c, double) { return c.v95CmS; }),
      footstep("footstep_rate", "1/s", "Footsteps at v95 per second of motion.",
               [](const FootstepCurve& c, double seconds) {
                 const auto at = std::find(c.toleranceCmS.begin(), c.toleranceCmS.end(), c.v95CmS);
                 return static_cast<double>(c.count[at - c.toleranceCmS.begin()]) / seconds;
               }),
      footstep("footstep_duration", "s", "Mean duration of the footsteps at v95.",
               [](const FootstepCurve& c, double) { return c.durationMeanS; }),
      footstep("footstep_duration_sd", "s",
               "Population standard deviation of the durations of the footsteps at v95.",
               [](const FootstepCurve& c, double) { return c.durationStdS; }),
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
    Unpacker bytes(part);
    bytes.number<double>();  // seconds
    FootstepTally& tally = out.emplace_back();
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
      {"foot_skate_height_weighted", "cm/s",
       "Mean of v (2 - 2^(h/H)), H = 2.5 cm, over feet and frames; 0 where h > H. v: horizontal "
       "speed, h: height above the 5th percentile of the foot's (natural) heights.",
       "Zhang et al. 2018 (MANN)", false, hasFeet, skate(heightWeightedSkate), combineRatio()});
  list.push_back(
      {"foot_skate_share", "%",
       "Share of frames in which some foot below 5 cm (above the 5th percentile of its natural "
       "heights) moves faster than 50 cm/s, that is 2.5 cm per frame at 20 fps.",
       "Karunratanakul et al. 2023 (Guided Motion Diffusion)", false, hasFeet, skate(skatingShare),
       combineRatio(percent)});
  list.push_back({"foot_contact_share", "%",
                  "Share of feet and frames in contact: squared displacement in 1/30 s below 0.02 "
                  "cm^2, that is slower than 4.24 cm/s.",
                  "Harvey et al. 2020 (LaFAN1), after Holden et al. 2016", false, hasFeet,
                  ratioRule(contact), combineRatio(percent)});
  return list;
}

}  // namespace marey::stats

// Statistics of feet: footsteps by tolerance, skate and contact.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "stats/footsteps.h"
#include "stats/sample_distance.h"
#include "stats/skate.h"
#include "stats/statistic.h"
#include "stats/weighted.h"

namespace marey::stats {
namespace {

const char* const kMoGlow = "Henter, Alexanderson, Beskow 2020 (MoGlow), Sec. 5.3";

bool hasFeet(const StatisticInput& input) {
  return !input.feet.empty();
}

/// A number read off the footstep curve; `seconds` is the weighted length of the clips.
using CurveReader = double (*)(const FootstepCurve& curve, double seconds);

WeightedValue fromCurve(const StatisticInput& input, CurveReader read) {
  const FootstepOptions options{.feet = input.feet, .stepCmS = input.footStepCmS};
  const auto tolerances = footstepTolerances(options);
  auto tallies = std::make_shared<std::vector<FootstepTally>>();
  std::vector<double> seconds;
  for (const Clip& clip : *input.clips) {
    tallies->push_back(footstepTally(clip, options));
    seconds.push_back(clip.seconds());
  }
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
          .prepare = [read](const StatisticInput& input) { return fromCurve(input, read); }};
}

RatioPart partOf(const SkateTally& tally) {
  return {tally.sum, tally.frames};
}

/// A rule that needs to know how high the feet stand: by natural motion where there is some.
using SkateRule = SkateTally (*)(const Clip&, const std::vector<int>&, const std::vector<double>&);

WeightedValue skate(const StatisticInput& input, SkateRule rule, double scale) {
  const auto heights = standingHeights(input.natural ? *input.natural : *input.clips, input.feet);
  return weightedRatio(
      *input.clips, [&](const Clip& clip) { return partOf(rule(clip, input.feet, heights)); },
      [scale](double ratio) { return scale * ratio; });
}

WeightedValue contact(const StatisticInput& input) {
  return weightedRatio(
      *input.clips, [&](const Clip& clip) { return partOf(contactShare(clip, input.feet)); },
      [](double share) { return 100.0 * share; });
}

/// The weighted median of all horizontal foot speeds.
WeightedValue medianSpeed(const StatisticInput& input) {
  auto values = std::make_shared<std::vector<std::pair<double, size_t>>>();
  for (size_t i = 0; i < input.clips->size(); ++i)
    for (int foot : input.feet)
      for (double speed : horizontalSpeedsCmS((*input.clips)[i], foot))
        values->emplace_back(speed, i);
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

std::vector<Statistic> footStatistics() {
  std::vector<Statistic> list = footsteps();
  list.push_back({"foot_speed_median", "cm/s", "Median horizontal speed of the feet over frames.",
                  "Marey", false, hasFeet, medianSpeed});
  list.push_back(
      {"foot_skate_height_weighted", "cm/s",
       "Mean of v (2 - 2^(h/H)), H = 2.5 cm, over feet and frames; 0 where h > H. v: horizontal "
       "speed, h: height above the 5th percentile of the foot's (natural) heights.",
       "Zhang et al. 2018 (MANN)", false, hasFeet,
       [](const StatisticInput& in) { return skate(in, heightWeightedSkate, 1.0); }});
  list.push_back(
      {"foot_skate_share", "%",
       "Share of frames in which some foot below 5 cm (above the 5th percentile of its natural "
       "heights) moves faster than 50 cm/s, that is 2.5 cm per frame at 20 fps.",
       "Karunratanakul et al. 2023 (Guided Motion Diffusion)", false, hasFeet,
       [](const StatisticInput& in) { return skate(in, skatingShare, 100.0); }});
  list.push_back({"foot_contact_share", "%",
                  "Share of feet and frames in contact: squared displacement in 1/30 s below 0.02 "
                  "cm^2, that is slower than 4.24 cm/s.",
                  "Harvey et al. 2020 (LaFAN1), after Holden et al. 2016", false, hasFeet,
                  contact});
  return list;
}

}  // namespace marey::stats

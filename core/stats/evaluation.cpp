#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "stats/bones.h"
#include "stats/interval.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

/// The values of a statistic in bootstrap resamples of controls.
std::vector<double> resampledValues(const WeightedValue& value, const ControlSets& sets,
                                    const EvaluationOptions& options) {
  std::vector<double> values;
  for (int r = 0; r < options.resamples; ++r)
    values.push_back(value(sets.drawn(options.seed, static_cast<uint32_t>(r))));
  return values;
}

Interval bootstrap(const WeightedValue& value, const ControlSets& sets,
                   const EvaluationOptions& options) {
  if (sets.ownCount() < 2) return {};
  return percentileInterval(resampledValues(value, sets, options));
}

/// Of a distance: both sides are resampled.
Interval distanceBootstrap(double distance, const WeightedValue& value, const ControlSets& sets,
                           const EvaluationOptions& options) {
  const size_t clusters = std::min(sets.ownCount(), sets.naturalCount());
  if (clusters < 2) return {};
  return distanceInterval(distance, resampledValues(value, sets, options), clusters);
}

/// Values between two sets of natural motion of the sizes at hand: of a comparison their distance,
/// else the absolute difference of their values. `value` was prepared with natural motion on both
/// sides.
std::vector<double> naturalDistances(const WeightedValue& value, bool comparison,
                                     const ControlSets& sets, const EvaluationOptions& options) {
  std::vector<double> out;
  for (int s = 0; s < options.splits; ++s) {
    const Weights two = sets.bothNatural(options.seed, static_cast<uint32_t>(s));
    out.push_back(comparison ? value(two) : std::abs(value({two.clips}) - value({two.natural})));
  }
  return out;
}

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<double> meanOf(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The parts of a statistic's rule in a set.
const std::vector<ClipPart>& partsFor(const Statistic& statistic,
                                      const std::vector<std::shared_ptr<const PartRule>>& rules,
                                      const StatisticSet& set) {
  const auto at = std::find(rules.begin(), rules.end(), statistic.rule) - rules.begin();
  return set.parts[static_cast<size_t>(at)];
}

void addNatural(StatisticResult& result, const Statistic& statistic,
                const std::vector<ClipPart>& parts, const StatisticSetting& setting,
                const ControlSets& sets, const EvaluationOptions& options) {
  if (!statistic.applies(setting)) return;
  const WeightedValue value = statistic.combine(parts, parts, setting);
  std::vector<double> distances;
  if (sets.naturalCount() >= 2)
    distances = naturalDistances(value, statistic.comparison, sets, options);
  result.noiseFloor = meanOf(distances);
  Interval interval;
  if (statistic.comparison) {
    result.natural = result.noiseFloor;
    interval = percentileInterval(std::move(distances));
  } else {
    const ControlSets own(setting.controls, {});
    result.natural = finite(value(own.once()));
    interval = bootstrap(value, own, options);
  }
  result.naturalLow = interval.low;
  result.naturalHigh = interval.high;
}

void checkSet(const std::vector<Clip>& clips, const Clip& first) {
  requireSameJoints(clips);
  for (const Clip& clip : clips) requireComparable(clip, first);
}

void checkInput(const StatisticInput& input) {
  if (!input.clips || input.clips->empty())
    throw InputError({.path = "statistics"}, "at least one clip", "none");
  checkSet(*input.clips, input.clips->front());
  if (input.natural) checkSet(*input.natural, input.clips->front());
  const auto checkControls = [](const std::vector<int>& controls, const std::vector<Clip>& clips) {
    if (!controls.empty() && controls.size() != clips.size())
      throwInput({.path = "statistics"}, fmt::format("the controls of {} clips", clips.size()),
                 "{}", controls.size());
  };
  checkControls(input.controls, *input.clips);
  if (input.natural) checkControls(input.naturalControls, *input.natural);
  if (input.wanted && input.wanted->size() != input.clips->size())
    throwInput({.path = "statistics"}, fmt::format("{} wanted paths", input.clips->size()), "{}",
               input.wanted->size());
}

SetFacts factsOfSet(const std::vector<Clip>& clips, const std::vector<int>& feet) {
  SetFacts out;
  for (const Clip& clip : clips) out.add(factsOf(clip, feet));
  return out;
}

StatisticSetting settingOf(const StatisticInput& input, const SetFacts* natural) {
  StatisticSetting out{.skeleton = input.clips->front().skeleton,
                       .feet = input.feet,
                       .toes = input.toes,
                       .footStepCmS = input.footStepCmS,
                       .controls = input.controls,
                       .naturalControls = input.naturalControls,
                       .own = factsOfSet(*input.clips, input.feet),
                       .natural = natural,
                       .wanted = input.wanted};
  out.completeReferences();
  return out;
}

StatisticSet setOf(const std::vector<Statistic>& statistics, const std::vector<Clip>& clips,
                   StatisticSetting setting, Progress& progress) {
  StatisticSet out{std::move(setting), SetParts(rulesOf(statistics).size())};
  for (size_t i = 0; i < clips.size(); ++i) {
    progress.throwIfCancelled();
    auto parts = partsOf(statistics, clips[i], i, out.setting);
    for (size_t r = 0; r < parts.size(); ++r) out.parts[r].push_back(std::move(parts[r]));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(clips.size()), "statistics");
  }
  return out;
}

}  // namespace

void requireComparable(const Clip& clip, const Clip& first) {
  if (clip.skeleton->names != first.skeleton->names)
    throwInput({.path = clip.name}, "the joints of " + first.name, "other joints");
  if (clip.fps != first.fps)
    throwInput({.path = clip.name}, fmt::format("{} fps as {}", first.fps, first.name), "{}",
               clip.fps);
}

std::vector<std::shared_ptr<const PartRule>> rulesOf(const std::vector<Statistic>& statistics) {
  std::vector<std::shared_ptr<const PartRule>> out;
  for (const Statistic& statistic : statistics)
    if (std::find(out.begin(), out.end(), statistic.rule) == out.end())
      out.push_back(statistic.rule);
  return out;
}

std::vector<ClipPart> partsOf(const std::vector<Statistic>& statistics, const Clip& clip,
                              size_t index, const StatisticSetting& setting) {
  std::vector<ClipPart> out;
  for (const auto& rule : rulesOf(statistics)) {
    const bool wanted =
        std::any_of(statistics.begin(), statistics.end(), [&](const Statistic& statistic) {
          return statistic.rule == rule && statistic.applies(setting);
        });
    out.push_back(wanted ? rule->part(clip, index, setting) : ClipPart());
  }
  return out;
}

bool appliesTo(const Statistic& statistic, const StatisticInput& input) {
  SetFacts natural;
  if (input.natural) natural = factsOfSet(*input.natural, input.feet);
  return statistic.applies(settingOf(input, input.natural ? &natural : nullptr));
}

WeightedValue prepared(const Statistic& statistic, const StatisticInput& input) {
  checkInput(input);
  Progress progress;
  const SetFacts facts = input.natural ? factsOfSet(*input.natural, input.feet) : SetFacts{};
  const StatisticSetting setting = settingOf(input, input.natural ? &facts : nullptr);
  if (!statistic.applies(setting))
    throw InputError({.path = "statistics", .item = statistic.name},
                     "clips and references that it can be computed from", "something missing");
  StatisticSet natural{.parts = {{}}};
  if (input.natural) {
    natural = setOf({statistic}, *input.natural, setting.ofNatural(), progress);
  }
  const StatisticSet set = setOf({statistic}, *input.clips, setting, progress);
  return statistic.combine(set.parts.front(), natural.parts.front(), set.setting);
}

double valueOf(const Statistic& statistic, const StatisticInput& input) {
  const ControlSets sets(
      input.controls.empty() ? controlsEach(input.clips->size()) : input.controls, {});
  return prepared(statistic, input)({sets.once().clips});
}

std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticSet& set, const StatisticSet* natural,
                                      const EvaluationOptions& options, Progress& progress) {
  const auto rules = rulesOf(statistics);
  const std::vector<ClipPart> none;
  const ControlSets sets(set.setting.controls,
                         natural ? natural->setting.controls : std::vector<int>());
  std::vector<StatisticResult> out;
  for (size_t i = 0; i < statistics.size(); ++i) {
    const Statistic& statistic = statistics[i];
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(statistics.size()),
                    statistic.name);
    if (!statistic.applies(set.setting)) continue;
    StatisticResult result{.name = statistic.name,
                           .unit = statistic.unit,
                           .definition = statistic.definition,
                           .source = statistic.source};
    const auto& naturalParts = natural ? partsFor(statistic, rules, *natural) : none;
    const auto& parts = partsFor(statistic, rules, set);
    result.leftOut = static_cast<size_t>(std::count(parts.begin(), parts.end(), ClipPart()));
    result.clips = parts.size() - result.leftOut;
    result.controls = sets.ownCount();
    const WeightedValue value = statistic.combine(parts, naturalParts, set.setting);
    result.value = value(sets.once());
    const Interval interval = statistic.comparison
                                  ? distanceBootstrap(result.value, value, sets, options)
                                  : bootstrap(value, sets, options);
    result.low = interval.low;
    result.high = interval.high;
    if (natural) addNatural(result, statistic, naturalParts, natural->setting, sets, options);
    out.push_back(std::move(result));
  }
  progress.report(1.0, "statistics");
  return out;
}

std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticInput& input, const EvaluationOptions& options,
                                      Progress& progress) {
  checkInput(input);
  Progress other = progress.part(0.0, 0.2), own = progress.part(0.2, 0.4),
           combining = progress.part(0.4, 1.0);
  const SetFacts facts = input.natural ? factsOfSet(*input.natural, input.feet) : SetFacts{};
  StatisticSetting setting = settingOf(input, input.natural ? &facts : nullptr);
  std::optional<StatisticSet> natural;
  if (input.natural) {
    natural = setOf(statistics, *input.natural, setting.ofNatural(), other);
  }
  const StatisticSet set = setOf(statistics, *input.clips, std::move(setting), own);
  return evaluate(statistics, set, natural ? &*natural : nullptr, options, combining);
}

std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticInput& input,
                                      const EvaluationOptions& options) {
  Progress progress;
  return evaluate(statistics, input, options, progress);
}

}  // namespace marey::stats

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "stats/bones.h"
#include "stats/sample_distance.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

/// Streams of the bootstrap stage that halve instead of resampling.
constexpr uint32_t kSplitStream = 1;

std::vector<int> ones(size_t count) {
  return std::vector<int>(count, 1);
}

struct Interval {
  std::optional<double> low, high;
};

Interval intervalOf(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.size() < 2) return {};
  std::sort(values.begin(), values.end());
  return {sortedQuantile(values, 0.025), sortedQuantile(values, 0.975)};
}

Interval bootstrap(const WeightedValue& value, size_t clips, const EvaluationOptions& options) {
  if (clips < 2) return {};
  std::vector<double> values;
  for (int r = 0; r < options.resamples; ++r) {
    const auto index = static_cast<uint32_t>(r);
    values.push_back(value({resampleWeights(static_cast<int>(clips), options.seed, index)}));
  }
  return intervalOf(std::move(values));
}

/// The clips in a random order (Fisher-Yates), so that halves are its two ends.
std::vector<int> shuffledIndices(size_t count, uint64_t seed, uint32_t split) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const RandomKey key{
      .seed = seed, .sample = split, .frame = kSplitStream, .stage = RandomStage::Bootstrap};
  for (size_t i = count; i-- > 1;) {
    const auto j =
        static_cast<size_t>(uniformAt(key, static_cast<uint32_t>(i)) * static_cast<double>(i + 1));
    std::swap(order[i], order[j]);
  }
  return order;
}

/// Values between random halves of natural clips: of a comparison their distance, else the
/// absolute difference of their values. `value` was prepared with natural motion on both sides.
std::vector<double> halfDistances(const WeightedValue& value, bool comparison, size_t clips,
                                  const EvaluationOptions& options) {
  std::vector<double> out;
  for (int s = 0; s < options.splits; ++s) {
    const auto order = shuffledIndices(clips, options.seed, static_cast<uint32_t>(s));
    std::vector<int> first(clips, 0);
    std::vector<int> second(clips, 0);
    for (size_t i = 0; i < clips; ++i) (i < clips / 2 ? first : second)[order[i]] = 1;
    out.push_back(comparison ? value({first, second}) : std::abs(value({first}) - value({second})));
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
                const EvaluationOptions& options) {
  const size_t count = setting.own.clips;
  if (!statistic.applies(setting)) return;
  const WeightedValue value = statistic.combine(parts, parts, setting);
  std::vector<double> halves;
  if (count >= 2) halves = halfDistances(value, statistic.comparison, count, options);
  result.noiseFloor = meanOf(halves);
  Interval interval;
  if (statistic.comparison) {
    result.natural = result.noiseFloor;
    interval = intervalOf(std::move(halves));
  } else {
    result.natural = finite(value({ones(count)}));
    interval = bootstrap(value, count, options);
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
                       .footStepCmS = input.footStepCmS,
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

std::vector<int> resampleWeights(int clips, uint64_t seed, uint32_t index) {
  std::vector<int> weights(static_cast<size_t>(clips), 0);
  const RandomKey key{.seed = seed, .sample = index, .stage = RandomStage::Bootstrap};
  for (int i = 0; i < clips; ++i) {
    const int drawn = static_cast<int>(uniformAt(key, static_cast<uint32_t>(i)) * clips);
    ++weights[std::min(drawn, clips - 1)];
  }
  return weights;
}

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
  return prepared(statistic, input)({ones(input.clips->size())});
}

std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticSet& set, const StatisticSet* natural,
                                      const EvaluationOptions& options, Progress& progress) {
  const auto rules = rulesOf(statistics);
  const std::vector<ClipPart> none;
  std::vector<StatisticResult> out;
  for (size_t i = 0; i < statistics.size(); ++i) {
    const Statistic& statistic = statistics[i];
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(statistics.size()),
                    statistic.name);
    if (!statistic.applies(set.setting)) continue;
    StatisticResult result{statistic.name,
                           statistic.unit,
                           statistic.definition,
                           statistic.source,
                           0.0,
                           {},
                           {},
                           {},
                           {},
                           {},
                           {}};
    const auto& naturalParts = natural ? partsFor(statistic, rules, *natural) : none;
    const WeightedValue value =
        statistic.combine(partsFor(statistic, rules, set), naturalParts, set.setting);
    result.value = value({ones(set.setting.own.clips)});
    const Interval interval = bootstrap(value, set.setting.own.clips, options);
    result.low = interval.low;
    result.high = interval.high;
    if (natural) addNatural(result, statistic, naturalParts, natural->setting, options);
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

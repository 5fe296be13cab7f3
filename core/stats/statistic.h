// Statistics of sets of clips as immutable objects: the command line, the report and the workbench
// loop over one registry, so that a new one appears everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "motion/clip.h"
#include "motion/features.h"

namespace marey::stats {

/// What statistics are computed from. All clips have the same joints and rate.
struct StatisticInput {
  const std::vector<Clip>* clips = nullptr;
  /// Natural motion to compare with; null where there is none.
  const std::vector<Clip>* natural = nullptr;
  /// Wanted root trajectory of every clip, at the clip's rate; null where there is none.
  const std::vector<std::vector<RootFrame>>* wanted = nullptr;
  std::vector<int> feet;     ///< joints of footstep and skate analysis; empty: none of these
  double footStepCmS = 1.0;  ///< increment of the footstep tolerance
};

/// How often each clip and each natural clip is counted; no natural weights: once each.
struct Weights {
  std::vector<int> clips;
  std::vector<int> natural = {};
};

/// A statistic made ready for one input: its value under weights. NaN where the weighted set has no
/// value (no footstep, no pair). This form makes a bootstrap cheap.
using WeightedValue = std::function<double(const Weights& weights)>;

struct Statistic {
  std::string name;         ///< "footstep_v95": stable, for JSON and CSV
  std::string unit;         ///< "cm/s"; "" for a pure number
  std::string definition;   ///< one sentence
  std::string source;       ///< paper, section or repository
  bool comparison = false;  ///< a distance to natural motion: 0 is the same
  /// Whether the input has what is needed (natural motion, feet, wanted paths, hips).
  std::function<bool(const StatisticInput&)> applies;
  std::function<WeightedValue(const StatisticInput&)> prepare;
};

/// Every statistic, in the order of tables.
const std::vector<Statistic>& allStatistics();
/// Throws UsageError naming the statistics there are.
const Statistic& statisticByName(const std::string& name);

/// Value over the clips of an input. Throws InputError where the statistic does not apply.
double valueOf(const Statistic& statistic, const StatisticInput& input);

struct StatisticResult {
  std::string name, unit, definition, source;
  double value = 0.0;
  /// 95 % percentile bootstrap over clips; none for fewer than two clips.
  std::optional<double> low, high;
  /// The same on the natural clips. A comparison has here its value between random halves of the
  /// natural clips (mean; 2.5 and 97.5 percentile): what a perfect model would get.
  std::optional<double> natural, naturalLow, naturalHigh;
  /// Natural against natural: mean absolute difference (of a comparison: mean distance) between
  /// random halves of the natural clips. A difference below it says nothing.
  std::optional<double> noiseFloor;
};

struct EvaluationOptions {
  int resamples = 400;  ///< of the bootstrap; 0: no intervals
  int splits = 20;      ///< random halvings of the natural clips; 0: no noise floor
  uint64_t seed = 1;
};

/// Every statistic that applies. Results do not depend on the order of statistics.
/// Throws InputError on invalid input (no clips, different joints or rates), CancelledError.
std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticInput& input, const EvaluationOptions& options,
                                      Progress& progress);
std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticInput& input,
                                      const EvaluationOptions& options = {});

/// Weights of bootstrap resample `index`: how often each of n clips was drawn in n draws.
std::vector<int> resampleWeights(int clips, uint64_t seed, uint32_t index);

// Parts of the registry, one per file.
std::vector<Statistic> footStatistics();
std::vector<Statistic> comparisonStatistics();

}  // namespace marey::stats

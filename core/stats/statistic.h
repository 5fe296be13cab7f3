// Statistics of sets of clips as immutable objects: the command line, the report and the workbench
// loop over one registry, so that a new one appears everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "motion/clip.h"
#include "motion/features.h"
#include "stats/controls.h"
#include "stats/footsteps.h"
#include "stats/statistic_parts.h"

namespace marey::stats {

/// What statistics are computed from. All clips have the same joints and rate.
struct StatisticInput {
  const std::vector<Clip>* clips = nullptr;
  /// Natural motion to compare with; null where there is none.
  const std::vector<Clip>* natural = nullptr;
  /// Wanted root trajectory of every clip, at the clip's rate; null where there is none.
  const std::vector<std::vector<RootFrame>>* wanted = nullptr;
  /// The number of the control that every clip follows; empty: each has one of its own.
  std::vector<int> controls = {};
  /// The same of natural clips and in the same numbering: a sample and the natural clip whose
  /// control it follows have one number. Empty: each has one of its own that no sample follows.
  std::vector<int> naturalControls = {};
  std::vector<int> feet;       ///< joints of footstep and skate analysis; empty: none of these
  std::vector<int> toes = {};  ///< joints of rules about toes; empty: toesOf the feet
  double footStepCmS = 1.0;    ///< increment of the footstep tolerance
};

/// A statistic made ready for one set: its value under weights. NaN where the weighted set has no
/// value (no footstep, no pair). This form makes a bootstrap cheap.
using WeightedValue = std::function<double(const Weights& weights)>;

/// How the part of one clip is worked out. Statistics may share a rule: it is followed once.
struct PartRule {
  /// "" of a clip that has nothing to add: it is left out, and counted as such.
  std::function<ClipPart(const Clip& clip, size_t index, const StatisticSetting& setting)> part;
};

struct Statistic {
  std::string name;         ///< "footstep_v95": stable, for JSON and CSV
  std::string unit;         ///< "cm/s"; "" for a pure number
  std::string definition;   ///< one sentence
  std::string source;       ///< paper, section or repository
  bool comparison = false;  ///< a distance to natural motion: 0 is the same
  /// Whether there is what is needed (natural motion, feet, wanted paths, hips).
  std::function<bool(const StatisticSetting&)> applies;
  std::shared_ptr<const PartRule> rule;
  /// From the parts of all clips, and of natural ones (worked out in their own setting) for a
  /// comparison.
  std::function<WeightedValue(const std::vector<ClipPart>& own,
                              const std::vector<ClipPart>& natural,
                              const StatisticSetting& setting)>
      combine;
};

/// The rules of statistics, each once: the order of SetParts.
std::vector<std::shared_ptr<const PartRule>> rulesOf(const std::vector<Statistic>& statistics);
/// What a clip adds to every rule; "" for rules of which no statistic applies.
std::vector<ClipPart> partsOf(const std::vector<Statistic>& statistics, const Clip& clip,
                              size_t index, const StatisticSetting& setting);

/// Every statistic, in the order of tables.
const std::vector<Statistic>& allStatistics();
/// Throws UsageError naming the statistics there are.
const Statistic& statisticByName(const std::string& name);

/// Whether a statistic applies to an input, and its value under weights.
bool appliesTo(const Statistic& statistic, const StatisticInput& input);
WeightedValue prepared(const Statistic& statistic, const StatisticInput& input);
/// Value over the clips of an input. Throws InputError where the statistic does not apply.
double valueOf(const Statistic& statistic, const StatisticInput& input);

struct StatisticResult {
  std::string name, unit, definition, source;
  double value = 0.0;
  /// 95 % bootstrap over controls; none for fewer than two of them. Of a comparison: corrected for
  /// the bias of distances between samples, with the natural side resampled as well (interval.h).
  std::optional<double> low, high;
  /// The same on the natural clips. A comparison has here its value between two sets of natural
  /// motion (mean; 2.5 and 97.5 percentile): what a perfect model would get.
  std::optional<double> natural, naturalLow, naturalHigh;
  /// Natural against natural: mean absolute difference (of a comparison: mean distance) between two
  /// sets drawn from the natural clips, of as many controls as either side has. A difference below
  /// it says nothing.
  std::optional<double> noiseFloor;
  size_t clips = 0, controls = 0;  ///< that the value comes from
  size_t leftOut = 0;              ///< clips that add nothing to it: too short for it, or alone
};

struct EvaluationOptions {
  int resamples = 400;  ///< of the bootstrap; 0: no intervals
  int splits = 40;      ///< pairs of sets out of the natural clips; 0: no noise floor
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

/// A set as its parts: what evaluate needs of clips.
struct StatisticSet {
  StatisticSetting setting;
  SetParts parts;  ///< by rule (see rulesOf) and clip
};
/// The same of sets whose parts were worked out before; `natural` (in a setting where it is its own
/// natural motion) may be null.
std::vector<StatisticResult> evaluate(const std::vector<Statistic>& statistics,
                                      const StatisticSet& set, const StatisticSet* natural,
                                      const EvaluationOptions& options, Progress& progress);
/// Throws InputError unless a clip can stand in one set with `first`: same joints, same rate.
void requireComparable(const Clip& clip, const Clip& first);

/// The rule of footstep counts, which a curve of the whole set can be made from as well.
std::shared_ptr<const PartRule> footstepRule();
std::vector<FootstepTally> footstepTallies(const std::vector<ClipPart>& parts);

// Parts of the registry, one per file.
std::vector<Statistic> footStatistics();
std::vector<Statistic> comparisonStatistics();

}  // namespace marey::stats

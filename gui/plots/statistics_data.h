// The registry of statistics over several sets, as rows of a table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gui/plots/motion_sets.h"

#include "base/job.h"
#include "experiment/comparison.h"
#include "stats/statistic.h"

namespace marey::gui {

/// All that a table was computed from; equal inputs give equal tables.
struct StatisticsInput {
  std::vector<MotionSet> sets;  ///< natural first, where there is any
  std::optional<TimeRange> range;
  std::string feet;  ///< joint names as in the document; empty: found by name
  double footStepCmS = 1.0;
  uint64_t seed = 1;
  /// Natural motion that sets are compared with; a set whose motions follow no natural clip is
  /// compared with all.
  NaturalChoice against = NaturalChoice::All;

  bool sameAs(const StatisticsInput& other) const;
  /// "Natural (119 of 120 motions), MG – circle (8 of 8 motions), 1.00 to 3.50 s"
  std::string text() const;
};

/// One statistic: a value per set, and natural motion beside it.
struct StatisticsRow {
  std::string name, unit, definition, source;
  std::vector<std::optional<stats::StatisticResult>> systems;  ///< of StatisticsTable::systems
  std::optional<double> natural, naturalLow, naturalHigh, noiseFloor;
};

struct StatisticsTable {
  StatisticsInput input;
  std::vector<std::string> systems;   ///< names of the sets that are not natural
  std::vector<std::string> compared;  ///< of every system, the natural motion it is compared with
  std::vector<StatisticsRow> rows;
  std::vector<std::string> notes;  ///< sets that were not compared, and why
};

/// With natural motion alone its own values fill the natural column.
/// A set of another skeleton than natural motion has its own values, without those that compare;
/// one that cannot be evaluated has none. Both are noted. Throws CancelledError.
StatisticsTable statisticsTable(const StatisticsInput& input, Progress& progress);

/// Header and rows with this separator: statistic, unit, value, low and high of every system and of
/// natural motion, noise floor, definition, source. Commas and quotes are escaped where ','
/// separates.
std::string statisticsText(const StatisticsTable& table, char separator);

}  // namespace marey::gui

// Footsteps against speed tolerance (Henter et al. 2020, Sec. 5.3) of several sets.
#pragma once

#include <optional>
#include <string>

#include "gui/plots/linked_grid.h"

#include "base/job.h"
#include "stats/footsteps.h"

namespace marey::gui {

struct FootstepQuery {
  std::string feet;  ///< joint names as in the document; empty, or none of these: found by name
  double stepCmS = 1.0;
};

/// One motion's part in the result of its set.
struct MotionSteps {
  MotionId id;
  double minutes = 0.0;
  std::vector<double> count;       ///< of all feet at each tolerance
  std::vector<double> durationsS;  ///< of its steps at v95 of the set
};

struct FootstepResult {
  SetLook look;
  double minutes = 0.0;
  stats::FootstepCurve all;
  std::vector<std::string> footNames;
  std::vector<stats::FootstepCurve> feet;  ///< one per foot
  std::vector<MotionSteps> motions;
};

/// Sets with nothing inside the range are left out; every set has the feet of its own skeleton. One
/// without feet is named in `leftOut`; without one InputError is thrown. Throws CancelledError.
std::vector<FootstepResult> footstepResults(const std::vector<MotionSet>& sets,
                                            const std::optional<TimeRange>& range,
                                            const FootstepQuery& query, Progress& progress,
                                            std::vector<std::string>* leftOut = nullptr);
/// Whether counts must be given per minute: the sets are of different length.
bool perMinute(const std::vector<FootstepResult>& results);
/// Curves with a dot at v95, and beside them how long the steps take at v95.
LinkedGrid footstepGrid(const std::vector<FootstepResult>& results);
/// The curves of single motions: the count that its set would have if all moved like it, and the
/// density of its step durations.
std::vector<ChartHighlight> footstepHighlights(const std::vector<FootstepResult>& results,
                                               const std::set<MotionId>& picked);

struct FootstepRow {
  std::string set, foot;  ///< foot "all" comes first of every set
  /// f of the set, and steps at v95 per minute: 60 times the statistic footstep_rate of a set of
  /// motions each on a control of its own.
  double steps = 0.0, stepsPerMinute = 0.0, v95CmS = 0.0, durationMeanS = 0.0, durationStdS = 0.0;
  std::vector<MotionId> ids;
};
std::vector<FootstepRow> footstepRows(const std::vector<FootstepResult>& results);

}  // namespace marey::gui

// Footsteps against speed tolerance (MoGlow 2020, Sec. 5.3) of several sets.
#pragma once

#include <optional>

#include "plots/linked_grid.h"

#include "base/job.h"
#include "stats/footsteps.h"

namespace marey::gui {

struct FootstepResult {
  SetLook look;
  double minutes = 0.0;
  stats::FootstepCurve all;
  std::vector<stats::FootstepCurve> feet;  ///< one per foot
};

/// Sets with nothing inside the range are left out. Throws InputError and CancelledError.
std::vector<FootstepResult> footstepResults(const std::vector<MotionSet>& sets,
                                            const std::optional<TimeRange>& range,
                                            const stats::FootstepOptions& options,
                                            Progress& progress);
/// Whether counts must be given per minute: the sets are of different length.
bool perMinute(const std::vector<FootstepResult>& results);
/// Curves with a dot at v95.
LinkedGrid footstepGrid(const std::vector<FootstepResult>& results);

struct FootstepRow {
  std::string set, foot;  ///< foot "all" comes first of every set
  double steps = 0.0, stepsPerMinute = 0.0, v95CmS = 0.0, durationMeanS = 0.0, durationStdS = 0.0;
  std::vector<MotionId> ids;
};
std::vector<FootstepRow> footstepRows(const std::vector<FootstepResult>& results,
                                      const std::vector<std::string>& footNames);

}  // namespace marey::gui

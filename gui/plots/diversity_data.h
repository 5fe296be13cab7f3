// How far the motions of a set are from each other, frame by frame: the statistic diversity over
// time.
#pragma once

#include <optional>

#include "gui/plots/linked_grid.h"

#include "base/job.h"
#include "stats/diversity.h"

namespace marey::gui {

struct DiversityCurve {
  SetLook look;
  double fps = 20.0;
  stats::PairCurve pairs;  ///< sums over pairs and motions behind every point, per frame
  int compared = 0;        ///< motions that pairs were made of
  /// How far every motion is from those that pairs were made of, per frame of it; NaN where none of
  /// them goes on.
  std::vector<std::vector<float>> motionsCm;  ///< of look.ids
};

/// Per frame (equal time from the start), the mean over pairs of motions of the root mean square
/// joint distance in the root frame. Of more than stats::kDiversityMotions motions, these many are
/// compared, spread evenly over the set. Sets of one motion are left out. Motions that follow
/// different controls (natural ones) differ because their paths do: the name of their curve says
/// so. A set whose motions have different rates or no left and right hip is named in `leftOut`;
/// without one InputError is thrown. Throws CancelledError.
std::vector<DiversityCurve> diversityCurves(const std::vector<MotionSet>& sets, Progress& progress,
                                            std::vector<std::string>* leftOut = nullptr);

/// Over all pairs and frames inside the range, as the statistic diversity; NaN where there is none.
double meanInRange(const DiversityCurve& curve, const std::optional<TimeRange>& range);
/// The curves, and where motions end before others a strip that says how many go on.
LinkedGrid diversityGrid(const std::vector<DiversityCurve>& curves);
/// How far single motions are from the others of their set.
std::vector<ChartHighlight> diversityHighlights(const std::vector<DiversityCurve>& curves,
                                                const std::set<MotionId>& picked);

}  // namespace marey::gui

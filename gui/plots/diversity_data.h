// How far the motions of a set are from each other, frame by frame.
#pragma once

#include <optional>

#include "plots/linked_grid.h"

#include "base/job.h"

namespace marey::gui {

struct DiversityCurve {
  SetLook look;
  double fps = 20.0;
  std::vector<double> distanceCm;  ///< per frame; NaN from where fewer than two motions go on
  int compared = 0;                ///< motions that pairs were made of
  /// How far every motion is from those that pairs were made of, per frame of it; NaN where none of
  /// them goes on.
  std::vector<std::vector<float>> motionsCm;  ///< of look.ids
};

/// Per frame (equal time from the start), the mean over pairs of motions of the root mean square
/// joint distance in the root frame: stats::pairDistances without its mean over time. Of more than
/// 48 motions, 48 spread evenly over the set are compared. Sets of one motion are left out.
/// Throws InputError on motions of different joints or rates or without left and right hip,
/// CancelledError.
std::vector<DiversityCurve> diversityCurves(const std::vector<MotionSet>& sets, Progress& progress);

/// Mean over the frames inside the range; NaN where there is none.
double meanInRange(const DiversityCurve& curve, const std::optional<TimeRange>& range);
LinkedGrid diversityGrid(const std::vector<DiversityCurve>& curves);
/// How far single motions are from the others of their set.
std::vector<ChartHighlight> diversityHighlights(const std::vector<DiversityCurve>& curves,
                                                const std::set<MotionId>& picked);

}  // namespace marey::gui

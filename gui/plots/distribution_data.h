// Samples of a quantity at joints, over sets of motions, and how far they are from natural motion.
#pragma once

#include <memory>
#include <optional>

#include "gui/plots/linked_grid.h"

#include "base/job.h"
#include "stats/joint_samples.h"

namespace marey::gui {

struct DistributionQuery {
  stats::Quantity quantity = stats::Quantity::Speed;
  std::vector<int> joints;  ///< that are plotted
  std::optional<TimeRange> range;
};

/// A quantity at one joint in the unit of stats::textOf.
struct JointValues {
  std::vector<double> pooled;                 ///< inside the range
  std::vector<std::vector<double>> byMotion;  ///< every frame from the start of each motion
};

struct DistributionSet {
  SetLook look;
  double fps = 20.0;
  std::vector<JointValues> values;  ///< one per joint of the query; empty where it is not defined
  /// 1-Wasserstein distance to natural motion for every joint of the skeleton; NaN where there is
  /// no natural motion or no such quantity. Empty for natural motion itself.
  std::vector<double> distance;
};

struct DistributionResult {
  DistributionQuery query;
  std::shared_ptr<const Skeleton> skeleton;
  std::vector<DistributionSet> sets;
  std::vector<std::string> leftOut;  ///< sets of another skeleton than the first one, and why
  std::vector<Vec3> meanPose;  ///< root frame (x left, y up, z ahead), metres, of the first set
};

/// Of sets with the joints of the first one. Throws InputError (Sideways and Forward need hips) and
/// CancelledError.
DistributionResult distributionResult(const std::vector<MotionSet>& sets,
                                      const DistributionQuery& query, Progress& progress);

enum class DistributionView { Density, Violin, Envelope };
/// One chart per joint of the query that has values.
LinkedGrid distributionGrid(const DistributionResult& result, DistributionView view);
/// Single motions over that grid: their own density, or their values over time.
std::vector<ChartHighlight> distributionHighlights(const DistributionResult& result,
                                                   DistributionView view,
                                                   const render::ChartGrid& shown,
                                                   const std::set<MotionId>& picked);

struct DistributionRow {
  std::string set, joint;
  double mean = 0.0, deviation = 0.0;  ///< population standard deviation
  double distance = 0.0;               ///< to natural motion; NaN for itself
  std::vector<MotionId> ids;
  int jointIndex = 0;
};
std::vector<DistributionRow> distributionRows(const DistributionResult& result);

}  // namespace marey::gui

// Log-likelihoods over time (numbers and units as in ClipScore).
#pragma once

#include <functional>
#include <optional>

#include "gui/plots/linked_grid.h"

#include "model/likelihood.h"

namespace marey::gui {

struct LikelihoodRun {
  MotionId id;
  int firstFrame = 0;  ///< of the first value
  std::vector<double> nats;
  std::vector<std::string> joints = {};  ///< that stand out, of every value; may be empty
};

struct LikelihoodGroup {
  SetLook look;
  double fps = 20.0;
  std::vector<LikelihoodRun> runs;
  std::string system;                    ///< whose density it is
  std::shared_ptr<const Skeleton> body;  ///< densities over other joints are not comparable
  std::string unit = {};                 ///< nor are those of another unit
  int notScored = 0;                     ///< motions that are counted elsewhere
};

/// Scores of natural clips under a system; null where there are none (NaturalMotions::scores).
using NaturalScores = std::function<const std::vector<ClipScore>*(const std::string& system)>;

/// Samples under their own model, and natural motion under every system (drawn dashed from the
/// second system on). Scores of samples are looked up in `groups`.
std::vector<LikelihoodGroup> likelihoodGroups(const std::vector<MotionGroup>& groups,
                                              const std::vector<std::string>& systems,
                                              const NaturalScores& naturalScores, double fps);

/// Centred running mean over `window` values (made odd), over fewer at the ends.
std::vector<double> runningMean(const std::vector<double>& values, int window);
/// The same over a time.
void smooth(std::vector<LikelihoodGroup>& groups, double seconds);

struct WorstFrame {
  MotionId id;
  double timeS = 0.0, nats = 0.0;
  std::string unit = {};   ///< of nats
  std::string joint = {};  ///< that stands out in it, where that is known
};
/// The least likely frame inside the range under one system, for densities of several have no
/// common scale: of its samples, and of natural motion where there are none.
std::optional<WorstFrame> worstFrame(const std::vector<LikelihoodGroup>& groups,
                                     const std::optional<TimeRange>& range,
                                     const std::string& system);
/// The systems of the groups, in their order.
std::vector<std::string> systemsIn(const std::vector<LikelihoodGroup>& groups);
/// "natural under MG+ 29 of 30 scored"; empty where all are.
std::string notScoredText(const std::vector<LikelihoodGroup>& groups);

/// What is said of one set of motions under one system.
struct LikelihoodRow {
  std::string name;    ///< of the set
  std::string system;  ///< whose model
  bool natural = false;
  LikelihoodSummary summary;
  std::string floor;  ///< what the number hangs on
};
/// What a model says of itself; null where it cannot be read.
using ModelFacts = std::function<std::shared_ptr<const ModelInfo>(const std::string& system)>;
/// Rows of the sets that likelihoodGroups draws, in that order, over the frames that every model
/// scores: the largest context decides.
std::vector<LikelihoodRow> likelihoodRows(const std::vector<MotionGroup>& groups,
                                          const std::vector<std::string>& systems,
                                          const NaturalScores& naturalScores,
                                          const ModelFacts& facts);

/// Median and 5 to 95 % band per group, or every motion as a line of a cloud: a chart for every
/// skeleton and unit, and where motions end before others a strip that says how many go on. A rule
/// shows what the linear-Gaussian autoregression of each system makes of the natural clips, where
/// it is known.
LinkedGrid likelihoodGrid(const std::vector<LikelihoodGroup>& groups,
                          const std::vector<LikelihoodRow>& rows, bool everyMotion);
/// A line at that frame, which stands for its motion.
void markWorst(LinkedGrid& grid, const std::vector<LikelihoodGroup>& groups,
               const WorstFrame& worst);
/// Single motions over the grid.
std::vector<ChartHighlight> likelihoodHighlights(const std::vector<LikelihoodGroup>& groups,
                                                 const std::set<MotionId>& picked);

}  // namespace marey::gui

// How fast and how sharply turning a path is at every frame, and where it leaves what natural
// motion does. No widgets.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "motion/clip.h"
#include "motion/features.h"

namespace marey {

/// Values at every frame of a path; that of the first frame repeats the second.
struct PathCurve {
  std::vector<RootFrame> frames;
  double fps = 20.0;
  std::vector<double> speedMS;
  std::vector<double> turnRadS;  ///< above 0: to the left

  double seconds() const {
    return frames.size() < 2 ? 0.0 : static_cast<double>(frames.size() - 1) / fps;
  }
};
PathCurve curveOf(std::vector<RootFrame> frames, double fps);

/// Of a model's training data, which may hold faults of capture, the outermost 0.5 % are left out.
struct Spread {
  double minimum = 0.0, low = 0.0;   ///< low: 5 % of the values lie below
  double high = 0.0, maximum = 0.0;  ///< high: 5 % lie above
};
/// Takes a copy, as it must be sorted. Throws NumericError where there is no value.
Spread spreadOf(std::vector<double> values);

struct PaceRange {
  Spread speedMS, turnRadS;
  size_t clips = 0;        ///< natural ones that were measured
  std::string model = {};  ///< whose training data were measured instead; empty: none
};
/// Of the root trajectories of clips, smoothed as models see them. Clips of one frame, and those
/// without hips, are left out; none where no clip is left. Throws CancelledError.
std::optional<PaceRange> paceOf(const std::vector<std::shared_ptr<const Clip>>& clips,
                                Progress& progress);

enum class Strain {
  None,
  Rare,    ///< outside the middle 90 % of natural motion
  Unseen,  ///< outside all of it
};
Strain strainOf(double value, const Spread& natural);
/// The stronger one of speed and turn rate at every frame.
std::vector<Strain> strainsOf(const PathCurve& curve, const std::optional<PaceRange>& natural);

}  // namespace marey

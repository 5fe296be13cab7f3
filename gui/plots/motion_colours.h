// Colours of motions by a value of every frame, on a scale that colour-blind people read too.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/job.h"
#include "experiment/motions.h"
#include "model/scorer.h"
#include "render/base/colours.h"

namespace marey::gui {

enum class ColourBy { System, Sample, Likelihood, Speed };

/// The ends of a colour scale.
struct ScaleRange {
  double low = 0.0, high = 1.0;
  double share(double value) const { return (value - low) / (high - low); }
};

using render::scaleColour;

/// 5 to 95 % of the finite values, never empty; none where no value is finite.
std::optional<ScaleRange> middleRange(std::vector<double> values);
/// NaN becomes grey.
std::vector<render::Colour> coloursOf(const std::vector<double>& values, const ScaleRange& range);

/// Nats at every frame of the clip, from a score at `modelFps`; NaN where nothing was scored.
std::vector<double> likelihoodPerFrame(const Clip& clip, const ClipScore& score, double modelFps);

/// Floor speed of the root, m/s at every frame.
std::vector<double> rootSpeeds(const Clip& clip);

struct MotionColours {
  std::optional<ScaleRange> scale;
  /// One per frame of the clip; of what had no value there is none.
  std::map<const Clip*, std::vector<render::Colour>> frames;
};

/// Of motions with their scores; `modelFps` is the rate of those. Throws CancelledError.
MotionColours coloursByValue(const std::vector<std::pair<ClipPtr, std::optional<ClipScore>>>& from,
                             ColourBy by, double modelFps, Progress& progress);

}  // namespace marey::gui

#include "gui/plots/motion_colours.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/path_curve.h"
#include "motion/roles.h"

namespace marey::gui {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<RootFrame> floorTrack(const Clip& clip) {
  if (rolesOf(*clip.skeleton).hasFacing()) return rootTrajectory(clip, FeatureSpec{});
  std::vector<RootFrame> out;
  for (int t = 0; t < clip.frameCount(); ++t)
    out.push_back({.x = clip.at(t, 0).x(), .z = clip.at(t, 0).z(), .heading = 0.0});
  return out;
}

}  // namespace

std::optional<ScaleRange> middleRange(std::vector<double> values) {
  values.erase(
      std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
      values.end());
  if (values.empty()) return std::nullopt;
  const Spread spread = spreadOf(std::move(values));
  // All values alike: a scale needs two ends.
  const double least = 1e-6 + 1e-6 * std::abs(spread.low);
  return ScaleRange{.low = spread.low, .high = std::max(spread.high, spread.low + least)};
}

std::vector<render::Colour> coloursOf(const std::vector<double>& values, const ScaleRange& range) {
  std::vector<render::Colour> out;
  out.reserve(values.size());
  for (double value : values)
    out.push_back(std::isfinite(value) ? scaleColour(range.share(value)) : render::grey(0.6));
  return out;
}

std::vector<double> likelihoodPerFrame(const Clip& clip, const ClipScore& score, double modelFps) {
  std::vector<double> out(static_cast<size_t>(clip.frameCount()), kNaN);
  for (size_t t = 0; t < out.size(); ++t) {
    const long frame = std::lround(static_cast<double>(t) / clip.fps * modelFps);
    const long k = frame - score.firstFrame;
    if (k >= 0 && k < static_cast<long>(score.loglikNats.size()))
      out[t] = score.loglikNats[static_cast<size_t>(k)];
  }
  return out;
}

std::vector<double> rootSpeeds(const Clip& clip) {
  return curveOf(floorTrack(clip), clip.fps).speedMS;
}

MotionColours coloursByValue(const std::vector<std::pair<ClipPtr, std::optional<ClipScore>>>& from,
                             ColourBy by, double modelFps, Progress& progress) {
  std::vector<std::vector<double>> values;
  std::vector<double> all;
  for (const auto& [clip, score] : from) {
    progress.throwIfCancelled();
    if (by == ColourBy::Speed)
      values.push_back(rootSpeeds(*clip));
    else
      values.push_back(score ? likelihoodPerFrame(*clip, *score, modelFps) : std::vector<double>{});
    all.insert(all.end(), values.back().begin(), values.back().end());
  }
  MotionColours out{.scale = middleRange(std::move(all)), .frames = {}};
  for (size_t i = 0; out.scale && i < from.size(); ++i) {
    progress.throwIfCancelled();
    if (!values[i].empty()) out.frames[from[i].first.get()] = coloursOf(values[i], *out.scale);
  }
  return out;
}

}  // namespace marey::gui

#include "panels/motion_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "panels/path_curve.h"

#include "motion/roles.h"

namespace marey::gui {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr render::Colour fromHex(unsigned rgb) {
  return {((rgb >> 16) & 255U) / 255.0, ((rgb >> 8) & 255U) / 255.0, (rgb & 255U) / 255.0, 1.0};
}

constexpr std::array<render::Colour, 9> kViridis = {
    fromHex(0x440154), fromHex(0x472d7b), fromHex(0x3b528b), fromHex(0x2c728e), fromHex(0x21918c),
    fromHex(0x28ae80), fromHex(0x5ec962), fromHex(0xaddc30), fromHex(0xfde725)};

std::vector<RootFrame> floorTrack(const Clip& clip) {
  if (rolesOf(*clip.skeleton).hasFacing()) return rootTrajectory(clip, FeatureSpec{});
  std::vector<RootFrame> out;
  for (int t = 0; t < clip.frameCount(); ++t)
    out.push_back({.x = clip.at(t, 0).x(), .z = clip.at(t, 0).z(), .heading = 0.0});
  return out;
}

}  // namespace

render::Colour scaleColour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto k = std::min(static_cast<size_t>(at), kViridis.size() - 2);
  return render::mix(kViridis[k], kViridis[k + 1], at - static_cast<double>(k));
}

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

}  // namespace marey::gui

#include "experiment/path_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/quantile.h"
#include "stats/sample_distance.h"

namespace marey {
PathCurve curveOf(std::vector<RootFrame> frames, double fps) {
  PathCurve out{.frames = std::move(frames), .fps = fps, .speedMS = {}, .turnRadS = {}};
  const size_t count = out.frames.size();
  out.speedMS.assign(count, 0.0);
  out.turnRadS.assign(count, 0.0);
  for (size_t i = 1; i < count; ++i) {
    const RootFrame& a = out.frames[i - 1];
    const RootFrame& b = out.frames[i];
    out.speedMS[i] = std::hypot(b.x - a.x, b.z - a.z) * fps;
    out.turnRadS[i] = std::remainder(b.heading - a.heading, 2.0 * std::numbers::pi) * fps;
  }
  if (count > 1) {
    out.speedMS[0] = out.speedMS[1];
    out.turnRadS[0] = out.turnRadS[1];
  }
  return out;
}

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) throw NumericError("a spread needs at least one value");
  std::sort(values.begin(), values.end());
  return {.minimum = values.front(),
          .low = sortedQuantile(values, 0.05),
          .high = sortedQuantile(values, 0.95),
          .maximum = values.back()};
}

std::optional<PaceRange> paceOf(const std::vector<std::shared_ptr<const Clip>>& clips,
                                Progress& progress) {
  std::vector<double> speeds;
  std::vector<double> turns;
  PaceRange out;
  for (size_t i = 0; i < clips.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(clips.size()));
    const Clip& clip = *clips[i];
    if (clip.frameCount() < 2 || !rolesOf(*clip.skeleton).hasFacing()) continue;
    const PathCurve curve = curveOf(rootTrajectory(clip, FeatureSpec{}), clip.fps);
    speeds.insert(speeds.end(), curve.speedMS.begin(), curve.speedMS.end());
    turns.insert(turns.end(), curve.turnRadS.begin(), curve.turnRadS.end());
    ++out.clips;
  }
  if (out.clips == 0) return std::nullopt;
  out.speedMS = spreadOf(std::move(speeds));
  out.turnRadS = spreadOf(std::move(turns));
  return out;
}

Strain strainOf(double value, const Spread& natural) {
  if (value < natural.minimum || value > natural.maximum) return Strain::Unseen;
  return value < natural.low || value > natural.high ? Strain::Rare : Strain::None;
}

std::vector<Strain> strainsOf(const PathCurve& curve, const std::optional<PaceRange>& natural) {
  std::vector<Strain> out(curve.frames.size(), Strain::None);
  if (!natural) return out;
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = std::max(strainOf(curve.speedMS[i], natural->speedMS),
                      strainOf(curve.turnRadS[i], natural->turnRadS));
  return out;
}

}  // namespace marey

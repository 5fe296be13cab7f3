#include "motion/resample.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace marey {
namespace {

/// Frame `t` of the result lies between source frames `index` and `index + 1`.
struct Blend {
  size_t index = 0;
  float weight = 0.0f;  ///< of frame index + 1
};

/// Slack for rates whose quotient is not exact in binary: a millionth of a source frame.
constexpr double kSlack = 1e-6;

std::vector<Blend> blends(int frames, double fromFps, double toFps) {
  const double last = frames - 1;
  const auto count = static_cast<size_t>(std::floor(last / fromFps * toFps + kSlack)) + 1;
  std::vector<Blend> out(count);
  for (size_t k = 0; k < count; ++k) {
    const double at = std::clamp(static_cast<double>(k) * fromFps / toFps, 0.0, last);
    const double whole = std::floor(at + kSlack);
    const double rest = std::max(0.0, at - whole);
    out[k] = {static_cast<size_t>(whole), static_cast<float>(rest < kSlack ? 0.0 : rest)};
  }
  return out;
}

template <typename T, typename Mix>
std::vector<T> blended(const std::vector<T>& values, size_t width, const std::vector<Blend>& plan,
                       const Mix& mix) {
  std::vector<T> out;
  out.reserve(plan.size() * width);
  for (const Blend& b : plan)
    for (size_t j = 0; j < width; ++j) {
      const T& from = values[b.index * width + j];
      out.push_back(b.weight == 0.0f ? from
                                     : mix(from, values[(b.index + 1) * width + j], b.weight));
    }
  return out;
}

Vec3 mixPositions(const Vec3& a, const Vec3& b, float weight) {
  return a + weight * (b - a);
}
Quat mixRotations(const Quat& a, const Quat& b, float weight) {
  return a.slerp(weight, b).normalized();
}

}  // namespace

Clip resampled(const Clip& clip, double fps) {
  if (!(fps > 0.0) || !std::isfinite(fps))
    throwInput({.path = clip.name}, "a positive frame rate to resample to", "{}", fps);
  if (fps == clip.fps || clip.frameCount() == 0) return clip;
  const auto width = static_cast<size_t>(clip.jointCount());
  const std::vector<Blend> plan = blends(clip.frameCount(), clip.fps, fps);
  Clip out = clip;
  out.fps = fps;
  out.positions = blended(clip.positions, width, plan, mixPositions);
  if (clip.transforms)
    out.transforms = {blended(clip.transforms->rotations, width, plan, mixRotations),
                      blended(clip.transforms->translations, width, plan, mixPositions)};
  return out;
}

}  // namespace marey

#include "motion/resample.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/kinematics.h"

namespace marey {
namespace {

/// Frame `t` of the result lies between source frames `index` and `index + 1`.
struct Blend {
  size_t index = 0;
  float weight = 0.0f;  ///< of frame index + 1; 0: frame `index` itself
};

/// Slack for rates whose quotient is not exact in binary: a millionth of a source frame.
constexpr double kSlack = 1e-6;

/// Positions further than this from those of their transforms are not made of them, metres.
constexpr float kOwnPositionsM = 1e-4f;

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

/// Between p1 and p2. Of differences, so that what does not move stays exactly where it is.
Vec3 catmullRom(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, float u) {
  const Vec3 in = 0.5f * (p2 - p0), out = 0.5f * (p3 - p1), chord = p2 - p1;
  return p1 + u * (in + u * ((3.0f * chord - 2.0f * in - out) + u * (in + out - 2.0f * chord)));
}

std::vector<Vec3> cubicBlended(const std::vector<Vec3>& values, size_t width,
                               const std::vector<Blend>& plan) {
  const size_t frames = values.size() / width;
  std::vector<Vec3> out;
  out.reserve(plan.size() * width);
  for (const auto& [index, weight] : plan)
    for (size_t j = 0; j < width; ++j) {
      const auto at = [&](size_t t) -> const Vec3& { return values[t * width + j]; };
      if (weight == 0.0f) {
        out.push_back(at(index));
        continue;
      }
      const Vec3 &p1 = at(index), &p2 = at(index + 1);
      // Beyond an end the motion goes straight on: the tangent there is that of the last chord.
      const Vec3 p0 = index > 0 ? at(index - 1) : Vec3(p1 - (p2 - p1));
      const Vec3 p3 = index + 2 < frames ? at(index + 2) : Vec3(p2 + (p2 - p1));
      out.push_back(catmullRom(p0, p1, p2, p3, weight));
    }
  return out;
}

std::vector<Quat> slerped(const std::vector<Quat>& values, size_t width,
                          const std::vector<Blend>& plan) {
  std::vector<Quat> out;
  out.reserve(plan.size() * width);
  for (const auto& [index, weight] : plan)
    for (size_t j = 0; j < width; ++j) {
      const Quat& from = values[index * width + j];
      out.push_back(
          weight == 0.0f ? from : from.slerp(weight, values[(index + 1) * width + j]).normalized());
    }
  return out;
}

bool madeOfTransforms(const Clip& clip) {
  const std::vector<Vec3> made = forwardKinematics(*clip.skeleton, *clip.transforms);
  return made.size() == clip.positions.size() &&
         std::equal(made.begin(), made.end(), clip.positions.begin(),
                    [](const Vec3& a, const Vec3& b) { return (a - b).norm() < kOwnPositionsM; });
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
  if (clip.transforms)
    out.transforms = {slerped(clip.transforms->rotations, width, plan),
                      cubicBlended(clip.transforms->translations, width, plan)};
  if (!clip.transforms || !madeOfTransforms(clip)) {
    out.positions = cubicBlended(clip.positions, width, plan);
    return out;
  }
  out.positions = forwardKinematics(*clip.skeleton, *out.transforms);
  for (size_t k = 0; k < plan.size(); ++k)
    if (plan[k].weight == 0.0f)
      std::copy_n(clip.positions.begin() + static_cast<long>(plan[k].index * width), width,
                  out.positions.begin() + static_cast<long>(k * width));
  return out;
}

}  // namespace marey

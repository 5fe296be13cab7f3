#include "io/npz_features.h"

#include <cmath>

#include "io/known_skeletons.h"
#include "io/normalise.h"
#include "motion/rotation.h"
#include "motion/skeleton_fit.h"

namespace marey::io {
namespace {

constexpr int kJoints = 21;
constexpr int kPoseWidth = kJoints * 3;
constexpr int64_t kWidth = kPoseWidth + 3;
constexpr double kFps = 20.0;

/// `clip` names the array's row, from 0. One value that is none would spoil all frames after it.
void requireFinite(const float* rows, int64_t frames, const Skeleton& skeleton, Place place) {
  static constexpr const char* kControl[] = {"sideways displacement", "forward displacement",
                                             "turn"};
  for (int64_t i = 0; i < frames * kWidth; ++i) {
    if (std::isfinite(rows[i])) continue;
    const auto column = static_cast<size_t>(i % kWidth);
    place.frame = i / kWidth + 1;
    place.item = column < kPoseWidth ? "joint '" + skeleton.names[column / 3] + "'"
                                     : kControl[column - kPoseWidth];
    throw InputError(place, "finite values", "NaN or infinity");
  }
}

/// World motion of one clip, in file units.
std::vector<Vec3> rebuilt(const float* rows, int64_t frames) {
  std::vector<Vec3> out;
  out.reserve(static_cast<size_t>(frames) * kJoints);
  double yaw = 0.0;
  Vec3d offset = Vec3d::Zero();
  for (int64_t t = 0; t < frames; ++t) {
    const float* row = rows + t * kWidth;
    const Quatd rotation = axisRotation(1, yaw);
    for (int j = 0; j < kJoints; ++j)
      out.emplace_back(
          (rotation * Vec3d(row[3 * j], row[3 * j + 1], row[3 * j + 2]) + offset).cast<float>());
    const float* control = row + kPoseWidth;
    yaw -= control[2];
    offset += axisRotation(1, yaw) * Vec3d(control[0], 0.0, control[1]);
  }
  return out;
}

Clip featureClip(const float* rows, int64_t frames, std::optional<double> fps,
                 const std::string& origin, int64_t number, int64_t count,
                 const ReadOptions& options) {
  Clip clip;
  clip.name = fmt::format("{}_{:04}", std::filesystem::path(origin).stem().string(), number);
  clip.skeleton = std::make_shared<const Skeleton>(locomotionSkeleton());
  clip.source.path = origin;
  const std::string where = fmt::format("{}, clip {} (of 0 to {})", origin, number, count - 1);
  requireFinite(rows, frames, *clip.skeleton, {.path = where});
  clip.positions = rebuilt(rows, frames);
  clip.fps = fps.value_or(kFps);
  validate(clip);
  clip.skeleton = withOffsetsFrom(clip);
  clip.source.format = "npz-features";
  clip.source.fps = clip.fps;
  if (options.unit.empty())
    clip.source.notes.push_back("unit cmu (5.6444 cm) is the habit of these files");
  if (!fps && !options.fps)
    clip.source.notes.push_back("20 frames per second is the habit of these files");
  return normalised(std::move(clip), {.unit = unitByName("cmu"), .up = "y"}, options);
}

}  // namespace

std::vector<Clip> featureClips(const NpzArrays& arrays, const std::string& origin,
                               const ReadOptions& options) {
  const Tensor& clips = arrays.numbers.at("clips");
  const Place place = placeOf(origin, "clips");
  if (clips.shape.size() != 3 || clips.shape[2] != kWidth)
    throw InputError(place, "the shape (clips, frames, 66)", clips.shapeText());
  if (clips.shape[0] == 0 || clips.shape[1] == 0)
    throw InputError(place, "at least one clip and frame", clips.shapeText());
  const std::vector<float> values = clips.toFloats();
  const int64_t count = clips.shape[0], frames = clips.shape[1];
  const std::optional<double> fps = rateIn(arrays, origin);
  std::vector<Clip> out;
  for (int64_t n = 0; n < count; ++n) {
    out.push_back(
        featureClip(values.data() + n * frames * kWidth, frames, fps, origin, n, count, options));
    // One body, so that the clips can be compared joint by joint.
    out.back().skeleton = out.front().skeleton;
  }
  return out;
}

}  // namespace marey::io

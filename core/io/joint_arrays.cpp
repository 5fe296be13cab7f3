#include "io/joint_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/known_skeletons.h"
#include "io/normalise.h"
#include "io/npz_values.h"
#include "motion/skeleton_fit.h"

namespace marey::io {
namespace {

constexpr double kFps = 20.0;

/// Mean length of a bone and how much it varies (standard deviation by mean).
struct BoneLength {
  double mean = 0.0, variation = 0.0;
};

BoneLength boneLength(const Clip& clip, int from, int to) {
  constexpr int kMostFrames = 200;
  const int step = std::max(1, clip.frameCount() / kMostFrames);
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (int t = 0; t < clip.frameCount(); t += step, n += 1.0) {
    const double length = (clip.at(t, to) - clip.at(t, from)).cast<double>().norm();
    sum += length;
    squares += length * length;
  }
  const double mean = sum / n;
  const double variance = std::max(0.0, squares / n - mean * mean);
  return {mean, mean > 0.0 ? std::sqrt(variance) / mean : INFINITY};
}

bool within(double a, double b, double factor) {
  return a > 0.0 && b > 0.0 && a < factor * b && b < factor * a;
}

/// Thighs, shanks and arms of SMPL's order: alike on both sides, of lasting length, thighs longer
/// than the hips are wide. Axis-angle rotations of the same shape fail.
bool isBody(const Clip& clip) {
  struct Limb {
    int left[2], right[2];
  };
  static constexpr Limb kLimbs[] = {{{1, 4}, {2, 5}},      // thighs
                                    {{4, 7}, {5, 8}},      // shanks
                                    {{16, 18}, {17, 19}},  // upper arms
                                    {{18, 20}, {19, 21}}};
  constexpr double kMostVariation = 0.15, kMostBetweenSides = 1.25, kMostThighByShank = 1.8;
  std::array<double, 4> lengths{};
  for (size_t i = 0; i < lengths.size(); ++i) {
    const BoneLength left = boneLength(clip, kLimbs[i].left[0], kLimbs[i].left[1]);
    const BoneLength right = boneLength(clip, kLimbs[i].right[0], kLimbs[i].right[1]);
    if (!within(left.mean, right.mean, kMostBetweenSides) || left.variation > kMostVariation ||
        right.variation > kMostVariation)
      return false;
    lengths[i] = left.mean;
  }
  return within(lengths[0], lengths[1], kMostThighByShank) &&
         lengths[0] > boneLength(clip, 0, 1).mean && lengths[0] > boneLength(clip, 0, 2).mean;
}

std::string shapeText(const std::vector<int64_t>& shape) {
  return Tensor{.dtype = DType::U8, .shape = shape, .bytes = {}}.shapeText();
}

[[noreturn]] void refuse(const std::string& origin, const std::vector<int64_t>& shape,
                         const std::string& meaning) {
  throw InputError(
      {.path = origin},
      fmt::format("joint positions (frames, 22, 3) in SMPL's order, or an NPZ with {}", kReadKeys),
      fmt::format("a NumPy array {}, {}", shapeText(shape), meaning));
}

Clip jointClip(const Tensor& tensor, std::vector<Vec3> positions, const std::string& origin,
               std::optional<double> fps, const ReadOptions& options) {
  const auto joints = static_cast<int>(tensor.shape[tensor.shape.size() - 2]);
  Clip clip;
  clip.name = std::filesystem::path(origin).stem().string();
  clip.skeleton = std::make_shared<const Skeleton>(*smplSkeleton(joints));
  clip.positions = std::move(positions);
  clip.fps = fps.value_or(kFps);
  clip.source.path = origin;
  clip.source.format = "npy";
  clip.source.fps = clip.fps;
  validate(clip);
  if (!isBody(clip))
    refuse(origin, tensor.shape,
           "whose values are no positions of SMPL's joints (rotations, or another order?)");
  clip.skeleton = withOffsetsFrom(clip);
  clip.source.notes.push_back(
      fmt::format("the {} joints have no names: taken in the order of SMPL", joints));
  if (!fps && !options.fps)
    clip.source.notes.push_back("20 frames per second is the habit of these files");
  return normalised(std::move(clip), {}, options);
}

std::string meaningOfRows(int64_t width) {
  if (width == 263) return "features (HumanML3D's 263 values a frame)";
  if (width == 251) return "features (KIT-ML's 251 values a frame)";
  if (width == 66)
    return "features or positions: 21 joints x 3 with three values of the root, or 22 joints x 3; "
           "save it as 'clips' (clips, frames, 66) or as (frames, 22, 3)";
  if (width > 0 && width % 3 == 0)
    return fmt::format("rows of {} numbers: positions or rotations of {} joints, or features",
                       width, width / 3);
  return "features";
}

}  // namespace

int canReadNpy(std::string_view head) {
  return head.starts_with("\x93NUMPY") ? 90 : 0;
}

bool hasShapeOfJoints(const Tensor& tensor) {
  const auto& shape = tensor.shape;
  const size_t rank = shape.size();
  return (rank == 3 || rank == 4) && shape[rank - 1] == 3 && tensor.count() > 0 &&
         smplSkeleton(static_cast<int>(std::min<int64_t>(shape[rank - 2], 1000))) != nullptr;
}

std::string meaningOfShape(const std::vector<int64_t>& shape) {
  const size_t rank = shape.size();
  const int64_t last = rank > 0 ? shape[rank - 1] : 0;
  const int64_t before = rank > 1 ? shape[rank - 2] : 0;
  if (std::find(shape.begin(), shape.end(), 0) != shape.end()) return "which is empty";
  if (rank < 2) return "too few axes for a motion";
  if (rank == 2) return last == 3 ? "one pose or one path" : meaningOfRows(last);
  if (last == 3 && before == 3) return "rotation matrices";
  if (last == 3)
    return fmt::format("joint positions (or rotations) of {} joints that are not named", before);
  if (before == 3)
    return "joint positions with their axes in another order: transpose them to (frames, joints, "
           "3)";
  if (last == 4) return "rotations (quaternions), not positions";
  if (last == 6) return "rotations (6 values a joint), not positions";
  return rank == 3 ? meaningOfRows(last) : "of a meaning that is not known";
}

std::vector<Clip> jointClips(const Tensor& tensor, const std::string& origin,
                             std::optional<double> fps, const ReadOptions& options) {
  if (!hasShapeOfJoints(tensor)) refuse(origin, tensor.shape, meaningOfShape(tensor.shape));
  const std::vector<Vec3> all = vectors(tensor);
  const int64_t count = tensor.shape.size() == 4 ? tensor.shape[0] : 1;
  const auto each = static_cast<std::ptrdiff_t>(all.size()) / count;
  std::vector<Clip> out;
  for (int64_t n = 0; n < count; ++n) {
    const std::string where =
        count == 1 ? origin : fmt::format("{}, clip {} (of 0 to {})", origin, n, count - 1);
    out.push_back(jointClip(tensor, {all.begin() + n * each, all.begin() + (n + 1) * each}, where,
                            fps, options));
    out.back().source.path = origin;
    out.back().name = std::filesystem::path(origin).stem().string();
    if (count > 1) out.back().name += fmt::format("_{:04}", n);
  }
  return out;
}

std::vector<Clip> readNpyClips(std::string_view bytes, const std::filesystem::path& path,
                               const ReadOptions& options) {
  const NpyArray array = parseNpyArray(bytes, path.string());
  if (!array.numbers) refuse(path.string(), array.shape, array.type);
  if (array.bytesUsed < bytes.size())
    throwInput({.path = path.string()}, "one NumPy array", "{} more bytes after the first ({})",
               bytes.size() - array.bytesUsed, array.summary());
  return jointClips(*array.numbers, path.string(), std::nullopt, options);
}

}  // namespace marey::io

#include <cmath>

#include "base/npy.h"
#include "io/known_skeletons.h"
#include "io/normalise.h"
#include "io/npz_clips.h"
#include "motion/rotation.h"
#include "motion/skeleton_fit.h"

namespace marey::io {
namespace {

constexpr int kFieldJoints = 21;
constexpr int64_t kFieldWidth = kFieldJoints * 3 + 3;
constexpr double kFieldFps = 20.0;

using Arrays = std::map<std::string, Tensor>;

Place placeOf(const std::string& origin, const std::string& array) {
  return {.path = origin, .item = "array '" + array + "'"};
}

/// World motion of one clip of the field's features, in file units.
std::vector<Vec3> rebuilt(const float* rows, int64_t frames) {
  std::vector<Vec3> out;
  out.reserve(static_cast<size_t>(frames) * kFieldJoints);
  double yaw = 0.0;
  Vec3d offset = Vec3d::Zero();
  for (int64_t t = 0; t < frames; ++t) {
    const float* row = rows + t * kFieldWidth;
    const Quatd rotation = axisRotation(1, yaw);
    for (int j = 0; j < kFieldJoints; ++j)
      out.emplace_back(
          (rotation * Vec3d(row[3 * j], row[3 * j + 1], row[3 * j + 2]) + offset).cast<float>());
    const float* control = row + kFieldJoints * 3;
    yaw -= control[2];
    offset += axisRotation(1, yaw) * Vec3d(control[0], 0.0, control[1]);
  }
  return out;
}

double rateIn(const Arrays& arrays, const std::string& origin, double fallback) {
  const auto fps = arrays.find("fps");
  if (fps == arrays.end()) return fallback;
  const std::vector<double> values = fps->second.toDoubles();
  if (values.size() != 1 || !(values[0] > 0.0) || !std::isfinite(values[0]))
    throw InputError(placeOf(origin, "fps"), "one positive number",
                     values.size() == 1 ? fmt::format("{}", values[0]) : fps->second.shapeText());
  return values[0];
}

std::vector<Clip> fieldClips(const Arrays& arrays, const std::string& origin,
                             const ReadOptions& options) {
  const Tensor& clips = arrays.at("clips");
  const Place place = placeOf(origin, "clips");
  if (clips.shape.size() != 3 || clips.shape[2] != kFieldWidth)
    throw InputError(place, "the shape (clips, frames, 66)", clips.shapeText());
  if (clips.shape[0] == 0 || clips.shape[1] == 0)
    throw InputError(place, "at least one clip and frame", clips.shapeText());
  const std::vector<float> values = clips.toFloats();
  const int64_t frames = clips.shape[1];
  std::vector<Clip> out;
  std::shared_ptr<const Skeleton> skeleton;
  for (int64_t n = 0; n < clips.shape[0]; ++n) {
    Clip clip;
    clip.name = fmt::format("{}_{:04}", std::filesystem::path(origin).stem().string(), n);
    clip.skeleton = std::make_shared<const Skeleton>(moglowSkeleton());
    clip.positions = rebuilt(values.data() + n * frames * kFieldWidth, frames);
    clip.fps = rateIn(arrays, origin, kFieldFps);
    clip.source.path = origin;
    validate(clip);
    clip.skeleton = withOffsetsFrom(clip);
    clip.source.format = "npz-features";
    clip.source.fps = clip.fps;
    if (options.unit.empty())
      clip.source.notes.push_back("unit cmu (5.6444 cm) is the habit of these files");
    if (!arrays.contains("fps") && !options.fps)
      clip.source.notes.push_back("20 frames per second is the habit of these files");
    clip = normalised(std::move(clip), {.unit = unitByName("cmu"), .up = "y"}, options);
    // One body, so that the clips can be compared joint by joint.
    if (!skeleton) skeleton = clip.skeleton;
    clip.skeleton = skeleton;
    out.push_back(std::move(clip));
  }
  return out;
}

const Tensor& need(const Arrays& arrays, const std::string& key, const std::string& origin,
                   const std::vector<int64_t>& shape) {
  const auto it = arrays.find(key);
  if (it == arrays.end()) throw InputError(placeOf(origin, key), "an array", "none");
  const auto& found = it->second.shape;
  bool fits = found.size() == shape.size();
  for (size_t i = 0; fits && i < shape.size(); ++i) fits = shape[i] < 0 || shape[i] == found[i];
  if (!fits)
    throw InputError(placeOf(origin, key), "the shape of the clip's joints and frames",
                     it->second.shapeText());
  return it->second;
}

std::vector<std::string> linesOf(const Arrays& arrays, const std::string& key) {
  std::vector<std::string> out;
  const auto it = arrays.find(key);
  if (it == arrays.end()) return out;
  const std::string text = tensorText(it->second);
  for (size_t begin = 0; begin <= text.size() && !text.empty();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

/// Joint numbers; an array of another type may hold them too.
std::vector<int64_t> wholeNumbers(const Tensor& tensor, const Place& place) {
  try {
    return tensor.toInt64();
  } catch (const NumericError& e) {
    throw InputError(place, "joint numbers", e.what());
  }
}

std::vector<Vec3> vectors(const Tensor& tensor) {
  const std::vector<float> values = tensor.toFloats();
  std::vector<Vec3> out(values.size() / 3);
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  return out;
}

std::vector<Quat> quaternions(const Tensor& tensor, const Place& place) {
  const std::vector<float> values = tensor.toFloats();
  std::vector<Quat> out(values.size() / 4);
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = Quat(values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]);
    const float norm = out[i].norm();
    if (!(std::abs(norm - 1.0f) < 1e-3f))
      throwInput(place, "quaternions of length 1", "length {} at number {}", norm, i);
    out[i].normalize();
  }
  return out;
}

Skeleton ownSkeleton(const Arrays& arrays, const std::string& origin, int64_t joints) {
  Skeleton out;
  out.names = linesOf(arrays, "joint_names");
  if (static_cast<int64_t>(out.names.size()) != joints)
    throwInput(placeOf(origin, "joint_names"), fmt::format("{} lines", joints), "{}",
               out.names.size());
  for (const int64_t parent :
       wholeNumbers(need(arrays, "parents", origin, {joints}), placeOf(origin, "parents"))) {
    if (parent < -1 || parent >= joints)
      throwInput(placeOf(origin, "parents"), "joint numbers or -1", "{}", parent);
    out.parents.push_back(static_cast<int>(parent));
  }
  out.offsets = vectors(need(arrays, "offsets", origin, {joints, 3}));
  if (!arrays.contains("end_site_parents")) return out;
  const std::vector<int64_t> sites = wholeNumbers(need(arrays, "end_site_parents", origin, {-1}),
                                                  placeOf(origin, "end_site_parents"));
  const auto count = static_cast<int64_t>(sites.size());
  const std::vector<Vec3> offsets = vectors(need(arrays, "end_site_offsets", origin, {count, 3}));
  for (size_t i = 0; i < sites.size(); ++i) {
    if (sites[i] < 0 || sites[i] >= joints)
      throwInput(placeOf(origin, "end_site_parents"), "joint numbers", "{}", sites[i]);
    out.endSites.push_back({static_cast<int>(sites[i]), offsets[i]});
  }
  return out;
}

void readSource(const Arrays& arrays, const std::string& origin, Clip& clip) {
  clip.source.format = "npz";
  clip.source.eulerOrders = linesOf(arrays, "euler_orders");
  const auto it = arrays.find("source");
  if (it == arrays.end()) return;
  const Json source = parseJson(tensorText(it->second), origin + ", array 'source'");
  if (!source.is_object() || !source.contains("notes") || !source["notes"].is_array()) return;
  for (const Json& note : source["notes"])
    if (note.is_string()) clip.source.notes.push_back(note.get<std::string>());
}

Clip ownClip(const Arrays& arrays, const std::string& origin, const ReadOptions& options) {
  const Tensor& positions = need(arrays, "positions", origin, {-1, -1, 3});
  const int64_t frames = positions.shape[0], joints = positions.shape[1];
  Clip clip;
  readSource(arrays, origin, clip);
  const std::vector<std::string> name = linesOf(arrays, "name");
  clip.name = name.empty() ? std::filesystem::path(origin).stem().string() : name.front();
  clip.source.path = origin;
  clip.skeleton = std::make_shared<const Skeleton>(ownSkeleton(arrays, origin, joints));
  validate(*clip.skeleton, origin);
  clip.positions = vectors(positions);
  need(arrays, "fps", origin, {1});
  clip.fps = rateIn(arrays, origin, 0.0);
  clip.source.fps = clip.fps;
  if (arrays.contains("rotations"))
    clip.transforms = {quaternions(need(arrays, "rotations", origin, {frames, joints, 4}),
                                   placeOf(origin, "rotations")),
                       vectors(need(arrays, "translations", origin, {frames, joints, 3}))};
  return normalised(std::move(clip), {.unit = unitByName("m"), .up = "y"}, options);
}

}  // namespace

int canReadNpz(std::string_view head) {
  return head.starts_with("PK\x03\x04") ? 60 : 0;
}

std::vector<Clip> clipsFromArrays(const Arrays& arrays, const std::string& origin,
                                  const ReadOptions& options) {
  if (arrays.contains("positions")) return {ownClip(arrays, origin, options)};
  if (arrays.contains("clips")) return fieldClips(arrays, origin, options);
  std::string names;
  for (const auto& [name, tensor] : arrays) names += (names.empty() ? "" : ", ") + name;
  throw InputError({.path = origin}, "an array 'clips' or 'positions'",
                   names.empty() ? "no array" : names.substr(0, 200));
}

std::vector<Clip> readNpzClips(std::string_view bytes, const std::filesystem::path& path,
                               const ReadOptions& options) {
  return clipsFromArrays(parseNpz(bytes, path.string()), path.string(), options);
}

}  // namespace marey::io

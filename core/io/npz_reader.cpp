#include <cmath>

#include "io/joint_arrays.h"
#include "io/normalise.h"
#include "io/npz_clips.h"
#include "io/npz_features.h"
#include "io/npz_values.h"
#include "motion/skeleton_fit.h"

namespace marey::io {
namespace {

const Tensor& need(const NpzArrays& arrays, const std::string& key, const std::string& origin,
                   const std::vector<int64_t>& shape) {
  const auto it = arrays.numbers.find(key);
  if (it == arrays.numbers.end())
    throw InputError(placeOf(origin, key), "an array of numbers",
                     arrays.contains(key) ? "no numbers" : "none");
  const auto& found = it->second.shape;
  bool fits = found.size() == shape.size();
  for (size_t i = 0; fits && i < shape.size(); ++i) fits = shape[i] < 0 || shape[i] == found[i];
  if (!fits)
    throw InputError(placeOf(origin, key), "the shape of the clip's joints and frames",
                     it->second.shapeText());
  return it->second;
}

/// Text as it stands in the array; "" where there is none. Older files hold it as UTF-8 bytes.
std::string textIn(const NpzArrays& arrays, const std::string& key) {
  if (const auto text = arrays.texts.find(key); text != arrays.texts.end())
    return text->second.values.empty() ? "" : text->second.values.front();
  const auto bytes = arrays.numbers.find(key);
  if (bytes == arrays.numbers.end() || bytes->second.dtype != DType::U8) return {};
  const auto& data = bytes->second.bytes;
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

/// Values of a list of text, or the lines of one text.
std::vector<std::string> listIn(const NpzArrays& arrays, const std::string& key) {
  const auto found = arrays.texts.find(key);
  if (found != arrays.texts.end() && !found->second.shape.empty()) return found->second.values;
  std::vector<std::string> out;
  const std::string text = textIn(arrays, key);
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

Skeleton ownSkeleton(const NpzArrays& arrays, const std::string& origin, int64_t joints) {
  Skeleton out;
  out.names = listIn(arrays, "joint_names");
  if (static_cast<int64_t>(out.names.size()) != joints)
    throwInput(placeOf(origin, "joint_names"), fmt::format("{} names", joints), "{}",
               out.names.size());
  for (const int64_t parent :
       wholeNumbers(need(arrays, "parents", origin, {joints}), placeOf(origin, "parents"))) {
    if (parent < -1 || parent >= joints)
      throwInput(placeOf(origin, "parents"), "joint numbers or -1", "{}", parent);
    out.parents.push_back(static_cast<int>(parent));
  }
  // Left out, they are measured: see ownClip.
  if (arrays.contains("offsets"))
    out.offsets = vectors(need(arrays, "offsets", origin, {joints, 3}));
  else
    out.offsets.assign(static_cast<size_t>(joints), Vec3::Zero());
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

void readSource(const NpzArrays& arrays, const std::string& origin, Clip& clip) {
  clip.source.format = "npz";
  clip.source.eulerOrders = listIn(arrays, "euler_orders");
  const std::string text = textIn(arrays, "source");
  if (text.empty()) return;
  const Json source = parseJson(text, origin + ", array 'source'");
  if (!source.is_object() || !source.contains("notes") || !source["notes"].is_array()) return;
  for (const Json& note : source["notes"])
    if (note.is_string()) clip.source.notes.push_back(note.get<std::string>());
}

Clip ownClip(const NpzArrays& arrays, const std::string& origin, const ReadOptions& options) {
  const Tensor& positions = need(arrays, "positions", origin, {-1, -1, 3});
  const int64_t frames = positions.shape[0], joints = positions.shape[1];
  Clip clip;
  readSource(arrays, origin, clip);
  clip.name = textIn(arrays, "name");
  if (clip.name.empty()) clip.name = std::filesystem::path(origin).stem().string();
  clip.source.path = origin;
  clip.skeleton = std::make_shared<const Skeleton>(ownSkeleton(arrays, origin, joints));
  validate(*clip.skeleton, origin);
  clip.positions = vectors(positions);
  const std::optional<double> fps = rateIn(arrays, origin);
  if (!fps) throw InputError(placeOf(origin, "fps"), "one positive number", "none");
  clip.fps = *fps;
  clip.source.fps = clip.fps;
  if (arrays.contains("rotations"))
    clip.transforms = {quaternions(need(arrays, "rotations", origin, {frames, joints, 4}),
                                   placeOf(origin, "rotations")),
                       vectors(need(arrays, "translations", origin, {frames, joints, 3}))};
  if (!arrays.contains("offsets")) {
    validate(clip);
    clip.skeleton = withOffsetsFrom(clip);
    clip.source.notes.push_back("offsets are not given: measured from the positions");
  }
  return normalised(std::move(clip), {.unit = unitByName("m"), .up = "y"}, options);
}

/// The only array that may hold the joints of a clip.
std::vector<Clip> onlyJoints(const NpzArrays& arrays, const std::string& origin,
                             const ReadOptions& options) {
  std::vector<std::string> candidates;
  for (const auto& [name, tensor] : arrays.numbers)
    if (hasShapeOfJoints(tensor)) candidates.push_back(name);
  const bool body = arrays.contains("poses") && arrays.contains("trans");
  if (candidates.size() == 1 && !body) {
    std::vector<Clip> out =
        jointClips(arrays.numbers.at(candidates[0]), origin, rateIn(arrays, origin), options);
    for (Clip& clip : out)
      clip.source.notes.push_back("positions are those of array '" + candidates[0] + "'");
    return out;
  }
  throw InputError({.path = origin}, kReadKeys,
                   body ? "body parameters of SMPL (poses, trans; AMASS): compute the joints with "
                          "its body model and save their positions"
                        : "arrays " + arrays.listing());
}

}  // namespace

int canReadNpz(std::string_view head) {
  return head.starts_with("PK\x03\x04") ? 60 : 0;
}

std::vector<Clip> clipsFromArrays(const NpzArrays& arrays, const std::string& origin,
                                  const ReadOptions& options) {
  // Without any word on the skeleton, positions are as good as an array of another name.
  const bool own = arrays.contains("positions") &&
                   (arrays.contains("joint_names") || arrays.contains("parents") ||
                    arrays.contains("rotations") || !arrays.numbers.contains("positions") ||
                    !hasShapeOfJoints(arrays.numbers.at("positions")));
  if (own) return {ownClip(arrays, origin, options)};
  if (arrays.numbers.contains("clips")) return featureClips(arrays, origin, options);
  if (arrays.contains("clips"))
    throw InputError(placeOf(origin, "clips"), "numbers of the shape (clips, frames, 66)",
                     arrays.listing());
  return onlyJoints(arrays, origin, options);
}

std::vector<Clip> readNpzClips(std::string_view bytes, const std::filesystem::path& path,
                               const ReadOptions& options) {
  return clipsFromArrays(parseNpzArrays(bytes, path.string()), path.string(), options);
}

}  // namespace marey::io

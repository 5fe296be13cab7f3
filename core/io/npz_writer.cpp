#include "base/npy.h"
#include "io/export_record.h"
#include "io/npz_clips.h"

namespace marey::io {
namespace {

Tensor vectorTensor(std::vector<int64_t> shape, const std::vector<Vec3>& values) {
  std::vector<float> flat;
  flat.reserve(values.size() * 3);
  for (const Vec3& v : values) flat.insert(flat.end(), {v.x(), v.y(), v.z()});
  return Tensor::fromFloats(std::move(shape), flat.data());
}

Tensor quaternionTensor(std::vector<int64_t> shape, const std::vector<Quat>& values) {
  std::vector<float> flat;
  flat.reserve(values.size() * 4);
  for (const Quat& q : values) flat.insert(flat.end(), {q.w(), q.x(), q.y(), q.z()});
  return Tensor::fromFloats(std::move(shape), flat.data());
}

void addSkeleton(const Skeleton& skeleton, NpzArrays& arrays) {
  const auto joints = static_cast<int64_t>(skeleton.names.size());
  const std::vector<int64_t> parents(skeleton.parents.begin(), skeleton.parents.end());
  auto& out = arrays.numbers;
  arrays.texts["joint_names"] = TextArray::list(skeleton.names);
  out["parents"] = Tensor::fromInt64({joints}, parents.data());
  out["offsets"] = vectorTensor({joints, 3}, skeleton.offsets);
  if (skeleton.endSites.empty()) return;
  std::vector<int64_t> siteParents;
  std::vector<Vec3> siteOffsets;
  for (const auto& site : skeleton.endSites) {
    siteParents.push_back(site.parent);
    siteOffsets.push_back(site.offset);
  }
  const auto sites = static_cast<int64_t>(siteParents.size());
  out["end_site_parents"] = Tensor::fromInt64({sites}, siteParents.data());
  out["end_site_offsets"] = vectorTensor({sites, 3}, siteOffsets);
}

void requireOwnUnits(const WriteOptions& options) {
  if ((!options.unit.empty() && options.unit != "m") || options.up != "y")
    throw UsageError("npz: expected metres and Y up, which this format always has, found unit '" +
                     options.unit + "' and up '" + options.up + "'");
}

}  // namespace

NpzArrays arraysOfClip(const Clip& clip, const Json& recipe) {
  const int64_t frames = clip.frameCount(), joints = clip.jointCount();
  NpzArrays out;
  addSkeleton(*clip.skeleton, out);
  out.texts["format"] = TextArray::one("marey-clip 2");
  out.texts["name"] = TextArray::one(clip.name);
  out.numbers["fps"] = Tensor::fromDoubles({1}, &clip.fps);
  out.numbers["positions"] = vectorTensor({frames, joints, 3}, clip.positions);
  if (clip.transforms) {
    out.numbers["rotations"] = quaternionTensor({frames, joints, 4}, clip.transforms->rotations);
    out.numbers["translations"] = vectorTensor({frames, joints, 3}, clip.transforms->translations);
  }
  if (!clip.source.eulerOrders.empty())
    out.texts["euler_orders"] = TextArray::list(clip.source.eulerOrders);
  out.texts["source"] = TextArray::one(jsonText(sourceJson(clip)));
  out.texts["recipe"] = TextArray::one(jsonText(recipe));
  return out;
}

std::vector<std::filesystem::path> writeNpzClip(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options) {
  requireOwnUnits(options);
  const Json details = {{"format", "npz"}, {"unit", "m"}, {"up", "y"}};
  writeNpz(path, arraysOfClip(clip, exportRecord(clip, options, details)));
  return {path};
}

}  // namespace marey::io

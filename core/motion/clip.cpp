#include "motion/clip.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace marey {
namespace {

template <typename T>
std::vector<T> sliceRows(const std::vector<T>& values, int width, int first, int last) {
  return {values.begin() + static_cast<long>(first) * width,
          values.begin() + static_cast<long>(last) * width};
}

template <typename T>
std::vector<T> withoutColumnZero(const std::vector<T>& values, int width) {
  std::vector<T> out;
  out.reserve(values.size());
  for (size_t i = 0; i < values.size(); ++i)
    if (i % static_cast<size_t>(width) != 0) out.push_back(values[i]);
  return out;
}

bool rootIsStatic(const Clip& clip) {
  const Skeleton& s = *clip.skeleton;
  if (s.jointCount() < 2 || std::count(s.parents.begin(), s.parents.end(), 0) != 1) return false;
  const Vec3 first = clip.at(0, 0);
  for (int t = 0; t < clip.frameCount(); ++t)
    if ((clip.at(t, 0) - first).norm() > 1e-6f) return false;
  // A body that merely stands still is kept: the joint below the root must differ from it.
  const Vec3 child = clip.at(0, 1);
  for (int t = 0; t < clip.frameCount(); ++t)
    if ((clip.at(t, 1) - child).norm() > 1e-6f) return true;
  return first.norm() < 1e-6f && (child - first).norm() > 1e-3f;
}

Skeleton dropRoot(const Skeleton& s) {
  Skeleton out = s;
  out.names.erase(out.names.begin());
  out.offsets.erase(out.offsets.begin());
  out.parents.erase(out.parents.begin());
  for (int& parent : out.parents) --parent;
  std::erase_if(out.endSites, [](const Skeleton::EndSite& e) { return e.parent == 0; });
  for (auto& site : out.endSites) --site.parent;
  return out;
}

/// Moves the root's transform into its only child.
JointTransforms dropRoot(const JointTransforms& in, int width) {
  JointTransforms out = in;
  for (size_t i = 0; i + 1 < in.rotations.size(); i += static_cast<size_t>(width)) {
    out.rotations[i + 1] = in.rotations[i] * in.rotations[i + 1];
    out.translations[i + 1] = in.translations[i] + in.rotations[i] * in.translations[i + 1];
  }
  return {withoutColumnZero(out.rotations, width), withoutColumnZero(out.translations, width)};
}

}  // namespace

void validate(const Clip& clip) {
  const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
  if (!clip.skeleton) throw InputError({.path = path}, "a skeleton", "none");
  validate(*clip.skeleton, path);
  if (clip.positions.empty()) throw InputError({.path = path}, "at least one frame", "zero frames");
  if (clip.positions.size() % static_cast<size_t>(clip.jointCount()) != 0)
    throwInput({.path = path}, fmt::format("{} joints in every frame", clip.jointCount()),
               "{} positions in all", clip.positions.size());
  if (!(clip.fps > 0.0) || !std::isfinite(clip.fps))
    throwInput({.path = path}, "a positive frame rate", "{}", clip.fps);
  const auto bad = std::find_if(clip.positions.begin(), clip.positions.end(),
                                [](const Vec3& p) { return !p.allFinite(); });
  if (bad == clip.positions.end()) return;
  const auto index = bad - clip.positions.begin();
  throw InputError(
      {.path = path,
       .frame = index / clip.jointCount() + 1,
       .item =
           "joint '" + clip.skeleton->names[static_cast<size_t>(index % clip.jointCount())] + "'"},
      "a finite position", "NaN or infinity");
}

Clip sliceFrames(const Clip& clip, int first, int last) {
  if (first < 0 || last > clip.frameCount() || first >= last)
    throwInput({.path = clip.name}, fmt::format("frames within 0..{}", clip.frameCount()), "{}:{}",
               first, last);
  Clip out = clip;
  const int width = clip.jointCount();
  out.positions = sliceRows(clip.positions, width, first, last);
  if (clip.transforms)
    out.transforms = {sliceRows(clip.transforms->rotations, width, first, last),
                      sliceRows(clip.transforms->translations, width, first, last)};
  out.annotations = startingAt(clip.annotations, first / clip.fps);
  return out;
}

Clip withoutStaticRoot(Clip clip) {
  if (clip.frameCount() == 0 || !rootIsStatic(clip)) return clip;
  const int width = clip.jointCount();
  clip.source.notes.push_back("root joint '" + clip.skeleton->names[0] + "' never moves: left out");
  if (!clip.source.eulerOrders.empty())
    clip.source.eulerOrders.erase(clip.source.eulerOrders.begin());
  clip.skeleton = std::make_shared<const Skeleton>(dropRoot(*clip.skeleton));
  clip.positions = withoutColumnZero(clip.positions, width);
  if (clip.transforms) clip.transforms = dropRoot(*clip.transforms, width);
  return clip;
}

}  // namespace marey

#include "stats/bones.h"

#include <cmath>

#include "base/error.h"

namespace marey::stats {
namespace {

double boneLength(const Clip& clip, int t, const std::pair<int, int>& bone) {
  return (clip.at(t, bone.first).cast<double>() - clip.at(t, bone.second).cast<double>()).norm();
}

}  // namespace

void requireSameJoints(const std::vector<Clip>& clips) {
  if (clips.empty()) throw InputError({.path = "clips"}, "at least one clip", "none");
  const Skeleton& first = *clips.front().skeleton;
  for (const Clip& clip : clips)
    if (clip.skeleton->names != first.names || clip.skeleton->parents != first.parents)
      throwInput({.path = clip.name},
                 fmt::format("the {} joints of {}", first.jointCount(), clips.front().name),
                 "{} joints or other names", clip.jointCount());
}

std::vector<double> skeletonBoneLengths(const Skeleton& skeleton) {
  std::vector<double> out;
  for (const auto& [parent, child] : skeleton.bones())
    out.push_back(skeleton.offsets[child].cast<double>().norm());
  return out;
}

std::vector<double> boneLengthSums(const Clip& clip) {
  const auto bones = clip.skeleton->bones();
  std::vector<double> sums(bones.size(), 0.0);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (size_t b = 0; b < bones.size(); ++b) sums[b] += boneLength(clip, t, bones[b]);
  return sums;
}

std::vector<double> meanBoneLengths(const std::vector<Clip>& clips) {
  requireSameJoints(clips);
  std::vector<double> sums(clips.front().skeleton->bones().size(), 0.0);
  double frames = 0.0;
  for (const Clip& clip : clips) {
    frames += clip.frameCount();
    const auto own = boneLengthSums(clip);
    for (size_t b = 0; b < sums.size(); ++b) sums[b] += own[b];
  }
  for (double& sum : sums) sum /= frames;
  return sums;
}

double squaredBoneError(const Clip& clip, const std::vector<double>& reference) {
  const auto bones = clip.skeleton->bones();
  if (bones.size() != reference.size())
    throwInput({.path = clip.name}, fmt::format("{} bones", reference.size()), "{}", bones.size());
  double sum = 0.0;
  for (int t = 0; t < clip.frameCount(); ++t)
    for (size_t b = 0; b < bones.size(); ++b)
      sum += std::pow(boneLength(clip, t, bones[b]) - reference[b], 2);
  return sum;
}

double boneLengthRmseCm(const std::vector<Clip>& clips, const std::vector<double>& reference) {
  requireSameJoints(clips);
  double sum = 0.0;
  double count = 0.0;
  for (const Clip& clip : clips) {
    sum += squaredBoneError(clip, reference);
    count += static_cast<double>(clip.frameCount()) * static_cast<double>(reference.size());
  }
  return count > 0.0 ? 100.0 * std::sqrt(sum / count) : 0.0;
}

}  // namespace marey::stats

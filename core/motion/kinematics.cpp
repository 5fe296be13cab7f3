#include "motion/kinematics.h"

#include "base/error.h"

namespace marey {
namespace {

size_t checkedFrames(const Skeleton& skeleton, const JointTransforms& local) {
  const auto width = static_cast<size_t>(skeleton.jointCount());
  if (width == 0 || local.rotations.size() % width != 0 ||
      local.rotations.size() != local.translations.size())
    throwInput({.path = "joint transforms"},
               fmt::format("rotations and translations of {} joints per frame", width),
               "{} rotations, {} translations", local.rotations.size(), local.translations.size());
  return local.rotations.size() / width;
}

/// World rotations and positions of one frame.
void solveFrame(const Skeleton& skeleton, const Quat* rotations, const Vec3* translations,
                Quat* worldRotations, Vec3* worldPositions) {
  const int width = skeleton.jointCount();
  worldRotations[0] = rotations[0];
  worldPositions[0] = translations[0];
  for (int j = 1; j < width; ++j) {
    const int parent = skeleton.parents[static_cast<size_t>(j)];
    worldRotations[j] = (worldRotations[parent] * rotations[j]).normalized();
    worldPositions[j] = worldPositions[parent] + worldRotations[parent] * translations[j];
  }
}

}  // namespace

std::vector<Vec3> forwardKinematics(const Skeleton& skeleton, const JointTransforms& local) {
  const size_t frames = checkedFrames(skeleton, local);
  const auto width = static_cast<size_t>(skeleton.jointCount());
  std::vector<Vec3> out(frames * width);
  std::vector<Quat> world(width);
  for (size_t t = 0; t < frames; ++t)
    solveFrame(skeleton, &local.rotations[t * width], &local.translations[t * width], world.data(),
               &out[t * width]);
  return out;
}

std::vector<Quat> globalRotations(const Skeleton& skeleton, const JointTransforms& local) {
  const size_t frames = checkedFrames(skeleton, local);
  const auto width = static_cast<size_t>(skeleton.jointCount());
  std::vector<Quat> out(frames * width);
  std::vector<Vec3> positions(width);
  for (size_t t = 0; t < frames; ++t)
    solveFrame(skeleton, &local.rotations[t * width], &local.translations[t * width],
               &out[t * width], positions.data());
  return out;
}

std::vector<Vec3> restPositions(const Skeleton& skeleton) {
  std::vector<Vec3> out(skeleton.offsets.begin(), skeleton.offsets.end());
  for (size_t j = 1; j < out.size(); ++j) out[j] += out[static_cast<size_t>(skeleton.parents[j])];
  return out;
}

std::vector<float> boneLengths(const Skeleton& skeleton) {
  std::vector<float> out;
  for (const auto& [parent, child] : skeleton.bones())
    out.push_back(skeleton.offsets[static_cast<size_t>(child)].norm());
  return out;
}

}  // namespace marey

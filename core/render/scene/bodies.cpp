#include "render/scene/bodies.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "motion/roles.h"

namespace marey::render {

namespace {
/// Longest way from each joint down to a leaf, in bones.
std::vector<int> levelsAboveLeaf(const Skeleton& skeleton) {
  std::vector<int> levels(static_cast<size_t>(skeleton.jointCount()), 0);
  for (int j = skeleton.jointCount() - 1; j > 0; --j) {
    int& parent = levels[static_cast<size_t>(skeleton.parents[static_cast<size_t>(j)])];
    parent = std::max(parent, levels[static_cast<size_t>(j)] + 1);
  }
  return levels;
}

/// Joints at or below the left hip or shoulder.
std::vector<bool> leftJoints(const Skeleton& skeleton, const SkeletonRoles& roles) {
  std::vector<bool> left(static_cast<size_t>(skeleton.jointCount()), false);
  for (int j = 1; j < skeleton.jointCount(); ++j) {
    left[static_cast<size_t>(j)] =
        j == roles.leftHip || j == roles.leftShoulder ||
        left[static_cast<size_t>(skeleton.parents[static_cast<size_t>(j)])];
  }
  return left;
}

int findHead(const Skeleton& skeleton) {
  for (int j = 1; j < skeleton.jointCount(); ++j) {
    std::string name = skeleton.names[static_cast<size_t>(j)];
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const size_t at = name.find("head");
    if (at != std::string::npos && name.find("end", at) == std::string::npos) return j;
  }
  return -1;
}

float longestBone(const Skeleton& skeleton, std::span<const Vec3> pose) {
  float longest = 0.0F;
  for (const auto& [parent, child] : skeleton.bones()) {
    longest = std::max(
        longest, (pose[static_cast<size_t>(child)] - pose[static_cast<size_t>(parent)]).norm());
  }
  return longest > 0.0F ? longest : 0.3F;
}
}  // namespace

BodyShape bodyShape(const Skeleton& skeleton, std::span<const Vec3> pose) {
  const SkeletonRoles roles = rolesOf(skeleton);
  const std::vector<int> levels = levelsAboveLeaf(skeleton);
  const std::vector<bool> left = leftJoints(skeleton, roles);
  const float unit = 0.072F * longestBone(skeleton, pose);
  const auto radius = [&](int joint) {
    return unit *
           (0.55F + 0.16F * static_cast<float>(std::min(levels[static_cast<size_t>(joint)], 4)));
  };
  BodyShape shape;
  for (const auto& [parent, child] : skeleton.bones()) {
    // A bone that starts a limb (hip, shoulder) is as thick at its root as at its end.
    shape.capsules.push_back({parent, child, std::min(radius(parent), 1.25F * radius(child)),
                              radius(child), left[static_cast<size_t>(child)]});
  }
  if (shape.capsules.empty()) shape.capsules.push_back({0, 0, unit, unit, false});
  shape.head = findHead(skeleton);
  if (shape.head >= 0) {
    shape.neck = skeleton.parents[static_cast<size_t>(shape.head)];
    shape.headRadiusM = (roles.quadruped ? 2.6F : 3.3F) * unit;
  }
  return shape;
}

Vec3 headCentre(const BodyShape& shape, std::span<const Vec3> pose) {
  const Vec3& head = pose[static_cast<size_t>(shape.head)];
  const Vec3 along = head - pose[static_cast<size_t>(shape.neck)];
  const float length = along.norm();
  return length < 1e-6F ? head : Vec3(head + along * (0.55F * shape.headRadiusM / length));
}

}  // namespace marey::render

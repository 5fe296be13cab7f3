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

struct Basis {
  Vec3 along, side, up;
};

/// Any two directions across `along`, chosen the same way every time.
Basis basisOf(const Vec3& along) {
  const Vec3 helper = std::abs(along.y()) < 0.9F ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 side = helper.cross(along).normalized();
  return {along, side, along.cross(side)};
}

void addVertex(Mesh& mesh, const Vec3& position, const Vec3& normal, const Colour& colour) {
  mesh.positions.insert(mesh.positions.end(), {position.x(), position.y(), position.z()});
  mesh.normals.insert(mesh.normals.end(), {normal.x(), normal.y(), normal.z()});
  const auto byte = [](double v) { return static_cast<uint8_t>(std::lround(v * 255.0)); };
  mesh.colours.insert(mesh.colours.end(), {byte(colour.r), byte(colour.g), byte(colour.b)});
}

/// The skin of the two end balls and the cone between them, as rings from pole to pole.
void appendCapsule(Mesh& mesh, const Vec3& a, const Vec3& b, float radiusA, float radiusB,
                   const Colour& colour, const MeshDetail& detail) {
  const Vec3 axis = b - a;
  const float length = axis.norm();
  const Basis basis = basisOf(length > 1e-6F ? Vec3(axis / length) : Vec3::UnitY());
  const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
  const int rings = 2 * (detail.rings + 1);
  for (int ring = 0; ring < rings; ++ring) {
    const bool atB = ring > detail.rings;
    const int step = atB ? ring - detail.rings - 1 : ring - detail.rings;
    const float angle = static_cast<float>(step) / static_cast<float>(detail.rings) *
                        static_cast<float>(M_PI) / 2.0F;
    for (int k = 0; k < detail.sides; ++k) {
      const float turn = 2.0F * static_cast<float>(M_PI) * static_cast<float>(k) /
                         static_cast<float>(detail.sides);
      const Vec3 normal =
          std::sin(angle) * basis.along +
          std::cos(angle) * (std::cos(turn) * basis.side + std::sin(turn) * basis.up);
      addVertex(mesh, (atB ? b : a) + (atB ? radiusB : radiusA) * normal, normal, colour);
    }
  }
  const auto sides = static_cast<uint32_t>(detail.sides);
  for (uint32_t ring = 0; ring + 1 < static_cast<uint32_t>(rings); ++ring) {
    for (uint32_t k = 0; k < sides; ++k) {
      const uint32_t next = (k + 1) % sides, here = first + ring * sides;
      mesh.triangles.insert(mesh.triangles.end(),
                            {here + k, here + next, here + sides + k, here + next,
                             here + sides + next, here + sides + k});
    }
  }
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

void appendPose(Mesh& mesh, const BodyShape& shape, std::span<const Vec3> pose,
                const Colour& colour, const MeshDetail& detail) {
  const Colour lighter = mix(colour, {1, 1, 1, 1}, 0.28);
  for (const Capsule& c : shape.capsules) {
    appendCapsule(mesh, pose[static_cast<size_t>(c.from)], pose[static_cast<size_t>(c.to)],
                  c.radiusFrom, c.radiusTo, c.leftSide ? lighter : colour, detail);
  }
  if (shape.head < 0) return;
  const Vec3 centre = headCentre(shape, pose);
  appendCapsule(mesh, centre, centre, shape.headRadiusM, shape.headRadiusM, colour,
                {detail.sides + 4, detail.rings + 2});
}

std::vector<Vec3> poseAt(const Clip& clip, double timeS) {
  const double at = std::clamp(timeS * clip.fps, 0.0, clip.frameCount() - 1.0);
  const int before = static_cast<int>(at);
  const int after = std::min(before + 1, clip.frameCount() - 1);
  const auto share = static_cast<float>(at - before);
  std::vector<Vec3> pose;
  pose.reserve(static_cast<size_t>(clip.jointCount()));
  for (int j = 0; j < clip.jointCount(); ++j) {
    pose.emplace_back(clip.at(before, j) * (1.0F - share) + clip.at(after, j) * share);
  }
  return pose;
}

}  // namespace marey::render

// Skeleton poses as meshes of tapered capsules: one mesh for any number of poses, so that a
// picture with thousands of bones is drawn in one batch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "motion/clip.h"
#include "render/base/colours.h"

namespace marey::render {

/// A round bone from one joint to another, or a ball where they are the same joint.
struct Capsule {
  int from = 0, to = 0;
  float radiusFrom = 0.03F, radiusTo = 0.03F;  ///< metres
  bool leftSide = false;  ///< drawn lighter, so that the legs can be told apart
};

/// The look of a skeleton, the same for every pose.
struct BodyShape {
  std::vector<Capsule> capsules;
  int head = -1;  ///< joint of the head ball, -1 for none
  int neck = -1;  ///< joint that the head ball points away from
  float headRadiusM = 0.0F;
};

/// Limbs taper towards hands and feet; sizes follow the longest bone of `pose` (joints, world
/// metres), so that people and dogs of any size look alike.
BodyShape bodyShape(const Skeleton& skeleton, std::span<const Vec3> pose);

/// Triangles with per-vertex normals and colours.
struct Mesh {
  std::vector<float> positions;     ///< vertices x 3, metres
  std::vector<float> normals;       ///< vertices x 3
  std::vector<uint8_t> colours;     ///< vertices x 3, sRGB
  std::vector<uint32_t> triangles;  ///< triangles x 3
};

/// How finely a capsule is divided.
struct MeshDetail {
  int sides = 12;  ///< around
  int rings = 4;   ///< from the rim to the pole of each end
};

/// Adds one pose (joints, world metres).
void appendPose(Mesh& mesh, const BodyShape& shape, std::span<const Vec3> pose,
                const Colour& colour, const MeshDetail& detail = {});

/// World position of the head ball's centre; only where shape.head >= 0.
Vec3 headCentre(const BodyShape& shape, std::span<const Vec3> pose);

/// Joint positions at a time, linear between frames; before the first and after the last frame
/// those frames. Shape: joints.
std::vector<Vec3> poseAt(const Clip& clip, double timeS);

}  // namespace marey::render

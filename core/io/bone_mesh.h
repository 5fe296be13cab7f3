// A body to see a skeleton by: one tapered bone per pair of joints, each moved by one joint.
#pragma once

#include <cstdint>
#include <vector>

#include "motion/clip.h"

namespace marey::io {

/// Flat-shaded triangles of the rest pose (see restPositions), counter-clockwise from outside.
struct BoneMesh {
  std::vector<Vec3> positions;   ///< metres
  std::vector<Vec3> normals;     ///< unit length
  std::vector<uint16_t> joints;  ///< per vertex, the joint that carries it
  std::vector<uint32_t> indices;
};

/// A bone from every joint to each child and end site, wide near the joint; a small octahedron
/// where a joint has neither. A bone belongs to the joint it starts from.
BoneMesh boneMesh(const Skeleton& skeleton);

}  // namespace marey::io

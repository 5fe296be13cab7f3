#include "io/bone_mesh.h"

#include <algorithm>
#include <array>

#include "motion/kinematics.h"

namespace marey::io {
namespace {

constexpr float kWidest = 0.05f;     ///< half width, metres
constexpr float kWidthShare = 0.1f;  ///< half width over length
constexpr float kRingAt = 0.2f;      ///< place of the widest part along the bone
constexpr float kShortestM = 1e-4f;  ///< bones below this are not drawn
constexpr float kTipM = 0.02f;       ///< half size of a joint without bones

class Builder {
 public:
  /// Two pyramids over one square ring.
  void addBone(const Vec3& from, const Vec3& to, float ringAt, float halfWidth, int joint) {
    const Vec3 along = (to - from).normalized();
    const Vec3 side = along.unitOrthogonal() * halfWidth;
    const Vec3 other = along.cross(side);
    const Vec3 middle = from + ringAt * (to - from);
    const std::array<Vec3, 4> ring = {middle + side, middle + other, middle - side, middle - other};
    for (size_t i = 0; i < ring.size(); ++i) {
      const Vec3& next = ring[(i + 1) % ring.size()];
      addTriangle(ring[i], next, to, joint);
      addTriangle(next, ring[i], from, joint);
    }
  }

  BoneMesh take() { return std::move(m_mesh); }

 private:
  void addTriangle(const Vec3& a, const Vec3& b, const Vec3& c, int joint) {
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3& corner : {a, b, c}) {
      m_mesh.indices.push_back(static_cast<uint32_t>(m_mesh.positions.size()));
      m_mesh.positions.push_back(corner);
      m_mesh.normals.push_back(normal);
      m_mesh.joints.push_back(static_cast<uint16_t>(joint));
    }
  }

  BoneMesh m_mesh;
};

}  // namespace

BoneMesh boneMesh(const Skeleton& skeleton) {
  Builder builder;
  const std::vector<Vec3> rest = restPositions(skeleton);
  std::vector<char> drawn(rest.size(), 0);
  const auto add = [&](int joint, const Vec3& offset) {
    if (offset.norm() < kShortestM) return;
    const Vec3& from = rest[static_cast<size_t>(joint)];
    builder.addBone(from, from + offset, kRingAt, std::min(kWidest, kWidthShare * offset.norm()),
                    joint);
    drawn[static_cast<size_t>(joint)] = 1;
  };
  for (const auto& [parent, child] : skeleton.bones())
    add(parent, skeleton.offsets[static_cast<size_t>(child)]);
  for (const auto& site : skeleton.endSites) add(site.parent, site.offset);
  for (size_t j = 0; j < rest.size(); ++j)
    if (drawn[j] == 0)
      builder.addBone(rest[j] - Vec3(0, kTipM, 0), rest[j] + Vec3(0, kTipM, 0), 0.5f, kTipM,
                      static_cast<int>(j));
  return builder.take();
}

}  // namespace marey::io

// Points and turns between the world and a root frame on the floor.
#pragma once

#include <cmath>

#include "motion/features.h"
#include "motion/rotation.h"

namespace marey {

inline Vec3 toRootFrame(const Vec3& p, const RootFrame& root) {
  const double c = std::cos(root.heading), s = std::sin(root.heading);
  const double dx = p.x() - root.x, dz = p.z() - root.z;
  return {static_cast<float>(c * dx - s * dz), p.y(), static_cast<float>(s * dx + c * dz)};
}

inline Vec3 fromRootFrame(const Vec3& p, const RootFrame& root) {
  const double c = std::cos(root.heading), s = std::sin(root.heading);
  return {static_cast<float>(root.x + c * p.x() + s * p.z()), p.y(),
          static_cast<float>(root.z - s * p.x() + c * p.z())};
}

/// From the frame's axes to the world's.
inline Quatd turnOf(const RootFrame& root) {
  return axisRotation(1, root.heading);
}

}  // namespace marey

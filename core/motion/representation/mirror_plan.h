// Left and right of a skeleton's rotations swapped, whatever its rest pose and the axes of its
// joints.
#pragma once

#include <vector>

#include "motion/rotation.h"
#include "motion/skeleton.h"

namespace marey {

/// With M the mirror at the plane x = 0 and m(j) the joint on the other side, the world rotation of
/// a mirrored joint is G'_j = M G_m(j) M C_j. The constant turn C_j is the one that takes mirrored
/// rest pose to rest pose, corrected so that the offsets of the joint's children are those of the
/// other side's mirrored: where the sides of a skeleton are as long, mirrored rotations put joints
/// exactly at mirrored positions. On a symmetric rest pose with the world's axes C_j is the
/// identity, and an exponential map (x, y, z) becomes (x, -y, -z).
class MirrorPlan {
 public:
  explicit MirrorPlan(const Skeleton& skeleton);
  /// Local rotations of one frame, the root's seen from the root frame. Twice is the identity.
  std::vector<Quatd> mirrored(const std::vector<Quatd>& local) const;

 private:
  std::vector<int> m_parents, m_other;
  std::vector<Quatd> m_turns;  ///< C_j
};

}  // namespace marey

// What the joints of a skeleton are, found by name over the naming habits of the field (see
// joint_names.h).
#pragma once

#include <string>
#include <vector>

#include "motion/skeleton.h"

namespace marey {

struct SkeletonRoles {
  int hips = 0;
  int leftHip = -1, rightHip = -1;            ///< upper-leg joints
  int leftShoulder = -1, rightShoulder = -1;  ///< upper-arm joints
  std::vector<int> feet;                      ///< contact joints of footstep analysis: ankles of a
                                              ///< biped, the four toes of a quadruped; left first
  std::vector<int> mirror;                    ///< joint on the other side; itself on the midline
  bool quadruped = false;
  bool animal = false;  ///< names of a tail, paws, hooves or wings: a person's size says nothing

  bool hasFacing() const { return leftHip >= 0 && rightHip >= 0; }
};

SkeletonRoles rolesOf(const Skeleton& skeleton);

/// Indices of comma-separated joint names. Throws InputError listing the joints there are.
std::vector<int> jointsByName(const Skeleton& skeleton, const std::string& commaSeparated);

}  // namespace marey

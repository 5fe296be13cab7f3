// A tree of joints. Parents come before their children; joint 0 is the root.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace marey {

struct Skeleton {
  /// A leaf that ends a bone without being a joint of the model (BVH 'End Site').
  struct EndSite {
    int parent = 0;
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< metres, parent's frame
  };

  std::vector<std::string> names;
  std::vector<int> parents;              ///< -1 for the root
  std::vector<Eigen::Vector3f> offsets;  ///< rest offset from the parent, metres, parent's frame
  std::vector<EndSite> endSites;
  /// Local rotations of the rest pose, for values that are relative to it; empty: all are the
  /// identity, as files have it.
  std::vector<Eigen::Quaternionf> rest = {};

  int jointCount() const { return static_cast<int>(names.size()); }
  /// Index of the joint of that name, or -1.
  int find(const std::string& name) const;
  /// (parent, child) of every bone, in joint order.
  std::vector<std::pair<int, int>> bones() const;
  bool operator==(const Skeleton&) const;
};

/// Throws InputError (naming `origin`) unless sizes agree, there is at least one joint,
/// joint 0 alone has no parent, parents precede children and offsets are finite.
void validate(const Skeleton& skeleton, const std::string& origin);

}  // namespace marey

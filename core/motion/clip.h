// A motion: world positions of every joint at every frame, and what the file said of it.
// Metres, seconds, radians, right-handed, Y up.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/annotations.h"
#include "motion/skeleton.h"

namespace marey {

using Vec3 = Eigen::Vector3f;
using Quat = Eigen::Quaternionf;

/// Local transforms, as hierarchical files store them: frame-major, frames x joints.
struct JointTransforms {
  std::vector<Quat> rotations;     ///< relative to the parent, unit length
  std::vector<Vec3> translations;  ///< relative to the parent, parent's frame, metres
};

/// What a reader found and converted from; kept for `doctor` and for provenance.
struct ClipSource {
  std::string path;
  std::string format;      ///< "bvh", "amc", "npz", "dog-text", "walker", "model", ...
  std::string unit = "m";  ///< unit of the file: "m", "cm", "inch", ...
  double metresPerUnit = 1.0;
  std::string up = "y";                  ///< "y" or "z"
  double fps = 0.0;                      ///< as written in the file
  std::vector<std::string> eulerOrders;  ///< per joint, "ZXY", "" where it has no rotation channels
  std::vector<std::string> notes;        ///< one sentence per conversion or guess
};

struct Clip {
  std::string name;
  std::shared_ptr<const Skeleton> skeleton;
  double fps = 0.0;
  std::vector<Vec3> positions;                ///< world, frames x joints
  std::optional<JointTransforms> transforms;  ///< where the source has rotations
  ClipSource source;
  Annotations annotations = {};  ///< of files beside its own, where there are any

  int jointCount() const { return skeleton ? skeleton->jointCount() : 0; }
  int frameCount() const {
    return jointCount() == 0
               ? 0
               : static_cast<int>(positions.size() / static_cast<size_t>(jointCount()));
  }
  double seconds() const { return frameCount() / fps; }
  std::span<const Vec3> frame(int t) const {
    return {positions.data() + static_cast<size_t>(t) * jointCount(),
            static_cast<size_t>(jointCount())};
  }
  std::span<Vec3> frame(int t) {
    return {positions.data() + static_cast<size_t>(t) * jointCount(),
            static_cast<size_t>(jointCount())};
  }
  const Vec3& at(int t, int joint) const {
    return positions[static_cast<size_t>(t) * jointCount() + joint];
  }
};

/// Throws InputError naming clip, frame and joint unless there is a frame, sizes agree, the
/// rate is positive and every position is finite.
void validate(const Clip& clip);

/// Frames [first, last) of a clip. Throws InputError when the range is empty or outside.
Clip sliceFrames(const Clip& clip, int first, int last);

/// The clip without a root joint that never moves and has exactly one child (exporters put
/// such a node at the origin); other clips unchanged. A note in `source` says so.
Clip withoutStaticRoot(Clip clip);

}  // namespace marey

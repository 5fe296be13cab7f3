// How a pose becomes numbers and back. Everything that must know what the values of a pose are
// asks the representation that a data set or model names (FeatureSpec::layout): nothing else
// assumes values per joint, a unit, or what mirroring does to them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "motion/clip.h"
#include "motion/features.h"

namespace marey {

enum class ChannelKind {
  Position,  ///< a coordinate, metres
  Rotation   ///< a component of an exponential map, radians
};

/// One value of a pose.
struct Channel {
  std::string name;  ///< "Hips.x", "Spine.rx"
  int joint = 0;
  ChannelKind kind = ChannelKind::Position;

  std::string_view unit() const { return kind == ChannelKind::Position ? "m" : "rad"; }
};

/// A clip that can be encoded.
struct ReadyClip {
  Clip clip;
  double fitM = 0.0;  ///< FeatureSequence::fitM
};

/// A value: all of its functions are deterministic and know no state. T frames, D = width.
struct Representation {
  std::string name;
  std::vector<std::string> formerNames;  ///< as which older files know it
  std::string description;               ///< a sentence for help and documentation
  std::string shownUnits;                ///< of the values in which likelihoods are shown: "cm"
  bool rotations = false;                ///< decoded clips have transforms
  /// Largest distance of a joint from where it was after encoding and decoding a clip that needs no
  /// fit and whose joints stay within 20 m of the origin, metres.
  double roundTripM = 0.0;

  /// Joints of poses that wide; -1: there are no such poses.
  int (*joints)(int width) = nullptr;
  std::vector<Channel> (*channels)(const Skeleton& skeleton) = nullptr;
  /// The skeleton that poses of these clips are of: joints of the first, with the rest pose that
  /// its values are relative to. Throws InputError as extractFeatures does.
  std::shared_ptr<const Skeleton> (*skeletonOf)(const std::vector<Clip>& clips,
                                                const FeatureSpec& spec) = nullptr;
  /// The clip with all that encoding needs, for poses of `skeleton`.
  ReadyClip (*ready)(Clip clip, const Skeleton& skeleton) = nullptr;
  /// Poses [T, D] of a ready clip with a root frame for each frame.
  Matrix (*encode)(const Clip& clip, const Skeleton& skeleton,
                   const std::vector<RootFrame>& trajectory) = nullptr;
  /// World motion (without a rate) of poses [T, D] with a root frame for each.
  Clip (*decode)(const Matrix& pose, const std::vector<RootFrame>& trajectory,
                 std::shared_ptr<const Skeleton> skeleton) = nullptr;
  /// Poses [T, D] of the body mirrored at the root frame's plane x = 0, left and right swapped.
  Matrix (*mirror)(const Matrix& pose, const Skeleton& skeleton) = nullptr;
  /// Poses [T, D] backwards in time.
  Matrix (*reverse)(const Matrix& pose) = nullptr;

  int width(const Skeleton& skeleton) const { return static_cast<int>(channels(skeleton).size()); }
};

std::span<const Representation> representations();
/// By its name or a former one. Throws InputError at `place`, listing the names.
const Representation& representationNamed(const std::string& name, const Place& place);
/// That of FeatureSpec::layout. Throws InputError naming `origin`.
const Representation& representationOf(const FeatureSpec& spec, const std::string& origin);

}  // namespace marey

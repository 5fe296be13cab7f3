// How an experiment is looked at: what a window keeps in a document beside what decides its
// numbers. Whoever needs no window hands it on as it is.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "task/steering.h"

#include "experiment/parts.h"

namespace marey {

/// A camera of the 3D view; world metres.
struct CameraPose {
  std::array<double, 3> eye{0, 1, 5}, target{0, 1, 0}, up{0, 1, 0};
  double heightM = 2.0;  ///< from the lower to the upper edge (orthographic)
  bool orthographic = false;
  bool operator==(const CameraPose&) const = default;
};

/// Names of the scene's choices, in the order of the numbers that stand for them.
inline constexpr std::array kColourNames{"system", "sample", "likelihood", "speed"};
inline constexpr std::array kPlacementNames{"world", "root_aligned", "side_by_side"};
inline constexpr std::array kDetailNames{"automatic", "capsules", "lines"};
inline constexpr std::array kTrailNames{"off", "joint", "feet"};

/// How figures and floor are drawn.
struct SceneLook {
  int colourBy = 0, placement = 0, detail = 0, trails = 0;  ///< indices of the names above
  double opacity = 1.0;
  double ghostsS = 0.0;  ///< a paler figure every so many seconds; 0: none
  int ghostFrames = 0;   ///< the same in frames, instead of seconds; 0: by seconds
  double trailS = 1.0;
  std::string naturalUnder;  ///< model whose likelihood colours natural motion; empty: the first
  bool contacts = false, shadow = true, path = true;
  bool operator==(const SceneLook&) const = default;
};

/// Clips of one natural source that are shown, by their number in it.
struct ShownClips {
  std::string source;
  std::vector<int> clips;
  bool operator==(const ShownClips&) const = default;
};

/// A sample set that was shown, by what it can be drawn from again.
struct KeptSet {
  ExperimentSystem system;
  ExperimentPath path;
  int samples = 1;
  uint64_t seed = 1;
  std::optional<Steering> steering = {};  ///< of a steered motion
  bool heldOut = false;                   ///< along the control of every natural clip
  bool pinned = false;
  int colour = 0;                 ///< of a set whose system the document lacks (a checkpoint)
  std::vector<int> hidden;        ///< its motions that are not shown
  std::vector<int> leftOut = {};  ///< its motions that are not counted
};

/// What motions are compared along.
enum class Comparison { ThisPath, HeldOut };

struct ViewState {
  std::string path;                                ///< name of the current one
  std::vector<std::string> notSampled;             ///< systems that are not ticked for sampling
  std::optional<std::vector<ShownClips>> natural;  ///< none: as a window shows them at first
  Comparison comparison = Comparison::ThisPath;
  SceneLook scene;
  std::optional<CameraPose> camera;
  bool follow = false;
  std::map<int, CameraPose> cameras;  ///< saved ones, by slot 1 to 9
  std::string trainingRun;            ///< folder whose checkpoints are looked at
  std::vector<KeptSet> sets;
};

/// Strict: unknown keys, wrong types and unknown names throw InputError naming `prefix` and the
/// key.
ViewState viewStateFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix);
/// Only what differs from a view that nobody has touched; an empty object: nothing does.
Json toJson(const ViewState& view);
Json toJson(const KeptSet& set);

}  // namespace marey

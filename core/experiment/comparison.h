// Which natural motion a set of motions is compared with, and which control every motion follows:
// the same words and numbers for the window, the report and the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiment/run.h"

namespace marey {

/// SameControl: the natural clips whose own control the motions follow. SameStyle: natural clips of
/// the same style (styleOf). All: every natural clip.
enum class NaturalChoice { SameControl, SameStyle, All };

/// "same-control", "same-style", "all". Throws UsageError naming the words there are.
NaturalChoice naturalChoiceByName(std::string_view name);
const char* nameOf(NaturalChoice choice);

/// The style of a clip, by its name without what follows it: "dataset-2_walk_active_001" and
/// "dataset-2_walk_active_017" are "dataset-2_walk_active". Names that are numbers alone are one
/// style of their own each.
std::string styleOf(const std::string& clipName);

/// Natural clips to compare with.
struct ComparedNatural {
  std::vector<size_t> clips;  ///< indices of the natural clips, rising
  NaturalChoice choice = NaturalChoice::All;
  size_t leftOut = 0;  ///< natural clips that are not compared with
  /// "the 12 natural clips whose control was followed", "all 101 natural clips", ...
  std::string text;
};

/// `follows`: for each motion the index of the natural clip whose control it follows, -1 where it
/// follows another path. Throws UsageError where no natural clip is left: no motion follows one.
ComparedNatural naturalToCompare(const std::vector<Clip>& natural, const std::vector<int>& follows,
                                 NaturalChoice choice);
/// The same of names alone, where clips are not at hand.
ComparedNatural naturalToCompare(const std::vector<std::string>& naturalNames,
                                 const std::vector<int>& follows, NaturalChoice choice);

/// For every held-out motion of a system, in its order, the natural clip whose control it follows.
std::vector<int> heldOutControls(const SystemResult& system, const Experiment& experiment);

}  // namespace marey

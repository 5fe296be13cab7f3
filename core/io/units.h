// Units of length and the guess which one a file is in, and which axis points up.
#pragma once

#include <string>
#include <vector>

#include "motion/clip.h"

namespace marey::io {

struct LengthUnit {
  std::string name;
  double metres = 1.0;
};

/// m, cm, mm, inch, foot, cmu. "cmu" is the unit of the CMU data base and of the field's NPZ files
/// derived from it: one inch divided by the ASF header's length 0.45, 5.6444 cm.
const std::vector<LengthUnit>& lengthUnits();
/// Throws UsageError naming the units there are.
const LengthUnit& unitByName(const std::string& name);

/// The size that the guess rests on, in the clip's unit, and what it is.
struct BodySize {
  double size = 0.0;
  std::string what;
  bool person = false;  ///< leg plus spine of an upright body that no name makes an animal
};
/// Bones have the lengths that they have in the poses.
BodySize bodySize(const Clip& clip);

struct UnitGuess {
  LengthUnit unit;
  double bodyM = 0.0;    ///< body size that follows from the guess, metres
  bool certain = false;  ///< bodyM is measured on a person and that of one (1.2 to 2.3 m)
  std::string evidence;
};

/// From the size of the body in file units: leg plus spine of a person, times 1.3 for foot and
/// head; the largest extent of other skeletons (animals, hands, joints not known by name), which
/// says little.
UnitGuess guessUnit(const Clip& clipInFileUnits);
/// The unit that a file states, as long as it makes a person of a person's size or the body is not
/// known to be one. Else the only unit that does, or the stated one without certainty.
UnitGuess checkedUnit(const Clip& clipInFileUnits, const LengthUnit& stated);

struct UpGuess {
  std::string up = "y";
  bool certain = false;
  std::string evidence;
};

/// From the mean direction from feet to trunk (hips and shoulders) over the clip (positions in file
/// axes). Y, uncertain, where those are not known.
UpGuess guessUp(const Clip& clip);

/// "y" or "z". Throws UsageError otherwise.
const std::string& checkedUp(const std::string& up);

}  // namespace marey::io

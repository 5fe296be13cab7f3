// From what a file holds to what Marey works with: metres, Y up, a positive rate, world positions.
#pragma once

#include <optional>

#include "io/format.h"
#include "io/units.h"

namespace marey::io {

/// What a format itself fixes; the rest is guessed from the content.
struct FormatFacts {
  std::optional<LengthUnit> unit;
  std::optional<std::string> up;
  /// The unit is what somebody wrote into the file: it is checked against the size of the body.
  bool unitFromFile = false;
};

/// Finishes a clip that is still in file units and axes: options override the format's facts,
/// facts override guesses. Positions are computed where only transforms are there. Conversions and
/// guesses are recorded in source.notes. Throws InputError (see validate(Clip)).
Clip normalised(Clip clip, const FormatFacts& facts, const ReadOptions& options);

/// Turns a Z-up clip into a Y-up one, (x, y, z) -> (x, z, -y), and back.
void turnToYUp(Clip& clip);
void turnToZUp(Clip& clip);
/// Gives every left joint the motion and the offset of its right one and the other way round, names
/// staying where they are. Throws InputError for a skeleton whose sides do not match.
void swapSides(Clip& clip);
/// Multiplies every length.
void scaleLengths(Clip& clip, double factor);

}  // namespace marey::io

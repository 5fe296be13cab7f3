// One fixed colour per system, told apart by people with any common colour blindness.
#pragma once

#include <string>

namespace marey::render {

/// sRGB and opacity, each in [0, 1].
struct Colour {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
  bool operator==(const Colour&) const = default;
};

/// Natural motion: near-black #222222.
Colour naturalColour();
/// System 0, 1, 2, ... of a comparison: the palette of Okabe and Ito (2008), "Color universal
/// design", without black and yellow (too light on white), then the same hues lighter or darker;
/// repeats after twelve. Below 0: natural motion.
Colour colourOf(int systemIndex);
/// For stages of one thing, such as checkpoints of a training: an index beyond those of systems
/// that colourOf gives a colour of scaleColour, darker for an early stage (0) than for a late (1).
int stageIndex(double share);
/// 0..1 on a scale that is even to every kind of vision, from dark to light: viridis (van der Walt
/// and Smith, 2015).
Colour scaleColour(double share);
/// Neutral ink for text, axes and grids; `lightness` 0 is black, 1 is white.
Colour grey(double lightness);

/// `amount` 0 gives `a`, 1 gives `b`; opacity is mixed as well.
Colour mix(const Colour& a, const Colour& b, double amount);
Colour withOpacity(Colour colour, double opacity);
/// As drawn on a dark background, where near-black, that of natural motion, cannot be told from it
/// and becomes light. Colours stay what they are: a scale's dark end means something.
Colour onDark(const Colour& colour);
/// "#rrggbb", opacity left out.
std::string hexOf(const Colour& colour);

}  // namespace marey::render

// Colours of a chart on light or dark ground. Charts name their colours as for white paper; a
// theme says what becomes of them.
#pragma once

#include "render/base/colours.h"

namespace marey::render {

/// The default leaves every colour as it is.
struct ChartTheme {
  Colour background = {1, 1, 1, 1};  ///< what white becomes
  Colour ink = {0, 0, 0, 1};         ///< what black becomes
  bool operator==(const ChartTheme&) const = default;
};

/// Near-white ink on `background`.
ChartTheme darkTheme(const Colour& background = {0.12, 0.12, 0.13, 1.0});

/// The colour on the theme's ground: greys go from ink to background, so that near-black natural
/// motion is light on a dark page; colours of systems keep their hue and are mixed with ink until
/// they stand out (contrast 4.5:1, as WCAG 2 asks for text). Opacity is kept.
Colour themed(const Colour& colour, const ChartTheme& theme);

/// Contrast of two opaque colours by WCAG 2: 1 (the same) to 21 (black on white).
double contrast(const Colour& a, const Colour& b);

}  // namespace marey::render

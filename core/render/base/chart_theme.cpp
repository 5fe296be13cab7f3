#include "render/base/chart_theme.h"

#include <algorithm>
#include <cmath>

namespace marey::render {

namespace {
double linear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double luminance(const Colour& c) {
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

bool isGrey(const Colour& c) {
  return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}) < 1e-6;
}
}  // namespace

ChartTheme darkTheme(const Colour& background) {
  return {.background = background, .ink = {0.96, 0.96, 0.96, 1.0}};
}

double contrast(const Colour& a, const Colour& b) {
  const double la = luminance(a), lb = luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

Colour themed(const Colour& colour, const ChartTheme& theme) {
  if (theme == ChartTheme{}) return colour;
  if (isGrey(colour)) return withOpacity(mix(theme.ink, theme.background, colour.r), colour.a);
  Colour lifted = colour;
  for (double amount = 0.1; amount < 1.0 && contrast(lifted, theme.background) < 4.5; amount += 0.1)
    lifted = mix(colour, theme.ink, amount);
  return withOpacity(lifted, colour.a);
}

}  // namespace marey::render

#include "render/colours.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace marey::render {

namespace {
constexpr Colour fromHex(unsigned rgb) {
  return {((rgb >> 16) & 255U) / 255.0, ((rgb >> 8) & 255U) / 255.0, (rgb & 255U) / 255.0, 1.0};
}

// Blue and vermillion first: the pair that stays furthest apart for every kind of vision.
constexpr std::array<Colour, 6> systemColours = {fromHex(0x0072B2), fromHex(0xD55E00),
                                                 fromHex(0x009E73), fromHex(0xCC79A7),
                                                 fromHex(0xE69F00), fromHex(0x56B4E9)};
}  // namespace

Colour naturalColour() {
  return fromHex(0x222222);
}

Colour colourOf(int systemIndex) {
  const int count = static_cast<int>(systemColours.size());
  return systemColours[static_cast<size_t>(((systemIndex % count) + count) % count)];
}

Colour grey(double lightness) {
  return {lightness, lightness, lightness, 1.0};
}

Colour mix(const Colour& a, const Colour& b, double amount) {
  return {std::lerp(a.r, b.r, amount), std::lerp(a.g, b.g, amount), std::lerp(a.b, b.b, amount),
          std::lerp(a.a, b.a, amount)};
}

Colour withOpacity(Colour colour, double opacity) {
  colour.a = opacity;
  return colour;
}

std::string hexOf(const Colour& colour) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(v * 255.0)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.r), byte(colour.g), byte(colour.b));
}

}  // namespace marey::render

#include "render/base/colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace marey::render {

namespace {
constexpr Colour fromHex(unsigned rgb) {
  return {((rgb >> 16) & 255U) / 255.0, ((rgb >> 8) & 255U) / 255.0, (rgb & 255U) / 255.0, 1.0};
}

// Blue and vermillion first: the pair that stays furthest apart for every kind of vision.
// The same hues follow, each made lighter or darker, whichever keeps the twelve furthest apart
// and all of them readable on white and on a dark background.
constexpr std::array<Colour, 12> systemColours = {
    fromHex(0x0072B2), fromHex(0xD55E00), fromHex(0x009E73), fromHex(0xCC79A7),
    fromHex(0xE69F00), fromHex(0x56B4E9), fromHex(0xA6CEE4), fromHex(0xECB78C),
    fromHex(0x8CD3C0), fromHex(0x663C54), fromHex(0xEFC159), fromHex(0x2F6380)};

constexpr std::array<Colour, 9> viridis = {fromHex(0x440154), fromHex(0x472D7B), fromHex(0x3B528B),
                                           fromHex(0x2C728E), fromHex(0x21918C), fromHex(0x28AE80),
                                           fromHex(0x5EC962), fromHex(0xADDC30), fromHex(0xFDE725)};

// Stages are the multiples of this from it on, so that an index next to one is a system again.
constexpr int stageStep = 1000, stages = 64;
// The ends of the scale are hard to see on black and on white.
constexpr double firstStage = 0.12, lastStage = 0.88;
}  // namespace

Colour naturalColour() {
  return fromHex(0x222222);
}

Colour colourOf(int systemIndex) {
  if (systemIndex < 0) return naturalColour();
  if (systemIndex >= stageStep && systemIndex % stageStep == 0)
    return scaleColour(std::lerp(firstStage, lastStage,
                                 static_cast<double>(systemIndex / stageStep - 1) / stages));
  const int count = static_cast<int>(systemColours.size());
  return systemColours[static_cast<size_t>(systemIndex % count)];
}

int stageIndex(double share) {
  return stageStep * (1 + static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * stages)));
}

Colour scaleColour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const auto k = std::min(static_cast<size_t>(at), viridis.size() - 2);
  return mix(viridis[k], viridis[k + 1], at - static_cast<double>(k));
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

Colour onDark(const Colour& colour) {
  constexpr double kNearBlack = 0.25, kNeutral = 0.1, kLifted = 0.82;
  const auto [least, most] = std::minmax({colour.r, colour.g, colour.b});
  if (most > kNearBlack || most - least > kNeutral) return colour;
  return withOpacity(mix(colour, grey(1.0), kLifted), colour.a);
}

std::string hexOf(const Colour& colour) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(v * 255.0)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.r), byte(colour.g), byte(colour.b));
}

}  // namespace marey::render

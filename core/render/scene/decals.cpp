#include "render/scene/decals.h"

#include <algorithm>
#include <cmath>

namespace marey::render {

namespace {
// Above each other, so that none flickers through another.
constexpr float discHeight = 0.003F, pathHeight = 0.005F, arrowHeight = 0.0065F,
                ringHeight = 0.008F;
constexpr float pathHalf = 0.011F;

Vec3 onFloor(const Vec3& p, float height) {
  return {p.x(), height, p.z()};
}

void addArrow(FigureStrokes& strokes, const Vec3& tip, const Vec3& direction, float size,
              const Rgba& ink) {
  const Vec3 side = Vec3::UnitY().cross(direction);
  for (const float sign : {-1.0F, 1.0F}) {
    const Vec3 tail = tip - size * direction + sign * 0.62F * size * side;
    strokes.addToLast({onFloor(tail, arrowHeight), onFloor(tip, arrowHeight), pathHalf, pathHalf,
                       ink, StrokeKind::Floor});
  }
}
}  // namespace

void addPath(FigureStrokes& strokes, std::span<const RootFrame> path, const Vec3& shift,
             const Colour& colour) {
  if (path.size() < 2) return;
  const Rgba ink = rgbaOf(colour);
  const auto place = [&](size_t i) {
    return Vec3(static_cast<float>(path[i].x) + shift.x(), pathHeight,
                static_cast<float>(path[i].z) + shift.z());
  };
  constexpr float shortest = 0.04F;
  Vec3 last = place(0), direction = Vec3::Zero();
  float length = 0.0F, nextArrow = 1.0F;
  strokes.addToLast({last, last, 0.045F, 0.045F, ink, StrokeKind::Floor});
  for (size_t i = 1; i < path.size(); ++i) {
    const Vec3 p = place(i);
    const float step = (p - last).norm();
    if (step < shortest && i + 1 < path.size()) continue;
    if (step < 1e-6F) continue;
    direction = (p - last) / step;
    strokes.addToLast({last, p, pathHalf, pathHalf, ink, StrokeKind::FloorLink});
    for (; nextArrow <= length + step; nextArrow += 1.0F)
      addArrow(strokes, last + (nextArrow - length) * direction, direction, 0.10F, ink);
    length += step;
    last = p;
  }
  if (length > shortest) addArrow(strokes, last, direction, 0.17F, ink);
}

void addRests(FigureStrokes& strokes, std::span<const Rest> rests, double timeS, const Vec3& shift,
              const Colour& colour) {
  constexpr float radius = 0.055F, half = 0.006F;
  for (const Rest& rest : rests) {
    if (rest.beginS > timeS) continue;
    const double fresh = timeS <= rest.endS ? 1.0 : 0.55;
    const Rgba ring = rgbaOf(withOpacity(colour, 0.9 * fresh * colour.a));
    const Rgba disc = rgbaOf(withOpacity(colour, 0.30 * fresh * colour.a));
    const Vec3 at = rest.place + shift, low = onFloor(at, discHeight),
               high = onFloor(at, ringHeight);
    strokes.addToLast({low, low, radius, radius, disc, StrokeKind::Floor});
    strokes.addToLast({high, high, radius, half, ring, StrokeKind::Ring});
  }
}

void addFootRing(FigureStrokes& strokes, const Vec3& root, float radiusM, const Colour& colour) {
  const Vec3 at = onFloor(root, ringHeight), low = onFloor(root, discHeight);
  strokes.addToLast(
      {low, low, radiusM, radiusM, rgbaOf(withOpacity(colour, 0.16)), StrokeKind::Floor});
  strokes.addToLast({at, at, radiusM, 0.012F, rgbaOf(withOpacity(colour, 0.9)), StrokeKind::Ring});
}

}  // namespace marey::render

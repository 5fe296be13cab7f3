#include "render/scene/soft_shadow.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace marey::render {

namespace {
constexpr float finest = 40.0F;         ///< texels per metre
constexpr int largest = 512;            ///< texels along an edge
constexpr double mostWork = 2.0e5;      ///< texels touched in one map
constexpr double worthThreads = 5.0e4;  ///< texels; fewer are done before a thread has started
constexpr float contactSoft = 0.02F;    ///< half the width of the soft rim at the floor, metres
constexpr float softPerM = 0.11F;       ///< and its growth with height

/// A limb seen by the light, metres on the floor.
struct Smear {
  Eigen::Vector2f from, to;
  float outer = 0.0F;  ///< where the shadow ends
  float depth = 0.0F;  ///< darkness in the middle
};

Smear smearOf(const ShadowLimb& limb, const Eigen::Vector2f& slant) {
  const auto shaded = [&](const Vec3& p) {
    return Eigen::Vector2f(p.x() + p.y() * slant.x(), p.z() + p.y() * slant.y());
  };
  const float height = std::max(0.0F, 0.5F * (limb.from.y() + limb.to.y()));
  const float soft = contactSoft + softPerM * height;
  // The same light is missing from a wider place.
  const float depth = 0.50F * limb.strength * (limb.radius + contactSoft) /
                      (limb.radius + contactSoft + 0.55F * softPerM * height);
  return {shaded(limb.from), shaded(limb.to), limb.radius + soft, depth};
}

double touched(const Smear& s, double perMetre) {
  return ((s.to - s.from).cwiseAbs().array() + 2.0F * s.outer).prod() * perMetre * perMetre;
}

FloorArea areaOf(const std::vector<Smear>& smears) {
  FloorArea area{1e9, 1e9, -1e9, -1e9};
  for (const Smear& s : smears) {
    for (const Eigen::Vector2f& p : {s.from, s.to}) {
      area.include(p.x() - s.outer, p.y() - s.outer);
      area.include(p.x() + s.outer, p.y() + s.outer);
    }
  }
  return area;
}

struct Rows {
  int first = 0, last = 0;  ///< both included
};

/// Darkest wins: overlapping limbs of one figure do not add up to a black spot, and it does not
/// matter in which order they are drawn.
void draw(const Smear& s, float perMetre, const Rows& rows, ShadowMap& map) {
  const Eigen::Vector2f origin(static_cast<float>(map.area.x0), static_cast<float>(map.area.z0));
  const Eigen::Vector2f a = (s.from - origin) * perMetre, b = (s.to - origin) * perMetre;
  const float outer = s.outer * perMetre;
  const Eigen::Vector2f low = a.cwiseMin(b).array() - outer, high = a.cwiseMax(b).array() + outer;
  const int x0 = std::max(1, static_cast<int>(low.x())),
            y0 = std::max(rows.first, static_cast<int>(low.y()));
  const int x1 = std::min(map.width - 2, static_cast<int>(high.x()));
  const int y1 = std::min(rows.last, static_cast<int>(high.y()));
  const Eigen::Vector2f axis = b - a;
  const float invLength2 = 1.0F / std::max(1e-6F, axis.squaredNorm());
  const float invOuter2 = 1.0F / (outer * outer), depth = 255.0F * s.depth;
  for (int y = y0; y <= y1; ++y) {
    uint8_t* row = map.light.data() + static_cast<size_t>(y) * map.width;
    const float dy = static_cast<float>(y) + 0.5F - a.y();
    for (int x = x0; x <= x1; ++x) {
      const float dx = static_cast<float>(x) + 0.5F - a.x();
      const float t = std::clamp((dx * axis.x() + dy * axis.y()) * invLength2, 0.0F, 1.0F);
      const float ex = dx - t * axis.x(), ey = dy - t * axis.y();
      const float fall = std::max(0.0F, 1.0F - (ex * ex + ey * ey) * invOuter2);
      const auto left = static_cast<uint8_t>(255.0F - depth * fall * fall);
      row[x] = std::min(row[x], left);
    }
  }
}

/// Each thread has rows of its own, so that the map is the same for any number of them.
void drawAll(std::span<const Smear> smears, float perMetre, bool large, ShadowMap& map) {
  const unsigned threads = large ? std::clamp(std::thread::hardware_concurrency(), 1U, 8U) : 1U;
  const int rows = map.height - 2;
  const auto drawBand = [&](unsigned band) {
    const auto edge = [&](unsigned b) { return 1 + static_cast<int>(b * rows / threads); };
    for (const Smear& s : smears) draw(s, perMetre, {edge(band), edge(band + 1) - 1}, map);
  };
  std::vector<std::jthread> others;
  for (unsigned band = 1; band < threads; ++band) others.emplace_back(drawBand, band);
  drawBand(0);
}
}  // namespace

void castSoftShadows(std::span<const ShadowLimb> limbs, const Eigen::Vector2f& slant,
                     ShadowMap& map) {
  if (limbs.empty()) {
    map = {};
    return;
  }
  std::vector<Smear> smears;
  smears.reserve(limbs.size());
  double work = 0.0;
  for (const ShadowLimb& limb : limbs) {
    smears.push_back(smearOf(limb, slant));
    work += touched(smears.back(), finest);
  }
  const FloorArea area = areaOf(smears);
  double perMetre = finest * std::min(1.0, std::sqrt(mostWork / work));
  perMetre = std::min(perMetre, (largest - 4) / std::max(area.width(), area.depth()));
  map.area = area.grown(2.0 / perMetre);
  map.width = static_cast<int>(std::ceil(map.area.width() * perMetre));
  map.height = static_cast<int>(std::ceil(map.area.depth() * perMetre));
  map.area.x1 = map.area.x0 + map.width / perMetre;
  map.area.z1 = map.area.z0 + map.height / perMetre;
  map.light.assign(static_cast<size_t>(map.width) * map.height, 255);
  drawAll(smears, static_cast<float>(perMetre), work > worthThreads, map);
}

}  // namespace marey::render

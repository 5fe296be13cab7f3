#include "render/scene/shadow_tiles.h"

#include <algorithm>

namespace marey::render {

namespace {
constexpr int tile = 8;  ///< texels along an edge

/// Interpolation reaches one texel beyond the tile.
bool isShaded(const ShadowMap& map, int x0, int y0) {
  const int left = std::max(0, x0 - 1), right = std::min(map.width, x0 + tile + 1);
  const int last = std::min(map.height, y0 + tile + 1);
  for (int y = std::max(0, y0 - 1); y < last; ++y) {
    const uint8_t* row = map.light.data() + static_cast<size_t>(y) * map.width;
    // All of a row at once is quicker than stopping at the first shaded one.
    uint8_t least = 255;
    for (int x = left; x < right; ++x) least = std::min(least, row[x]);
    if (least < 255) return true;
  }
  return false;
}
}  // namespace

std::vector<FloorArea> shadedAreas(const ShadowMap& map) {
  const double dx = map.area.width() / map.width, dz = map.area.depth() / map.height;
  std::vector<FloorArea> areas;
  for (int y = 0; y < map.height; y += tile) {
    bool open = false;  // whether the tile before was shaded too
    for (int x = 0; x < map.width; x += tile) {
      const bool shaded = isShaded(map, x, y);
      const double right = map.area.x0 + dx * std::min(map.width, x + tile);
      if (shaded && open) {
        areas.back().x1 = right;
      } else if (shaded) {
        areas.push_back({map.area.x0 + dx * x, map.area.z0 + dz * y, right,
                         map.area.z0 + dz * std::min(map.height, y + tile)});
      }
      open = shaded;
    }
  }
  return areas;
}

}  // namespace marey::render

#include "render/scene/composite.h"

#include <array>
#include <cmath>

namespace marey::render {

namespace {
/// What remains of a see-through figure's opacity in front of a solid one.
constexpr double thinning = 0.45;

void blend(uint8_t* to, const uint8_t* from, int share) {
  for (int c = 0; c < 3; ++c) {
    to[c] = static_cast<uint8_t>((to[c] * (256 - share) + from[c] * share + 128) >> 8);
  }
}
}  // namespace

void composite(Rendered& floor, const std::vector<LayerPicture>& layers) {
  const size_t pixels = floor.depth.size();
  std::array<size_t, mostLayers + 1> order{};
  for (size_t p = 0; p < pixels; ++p) {
    size_t seen = 0;
    for (size_t k = 0; k < layers.size(); ++k) {
      const float depth = layers[k].picture.depth[p];
      if (depth >= floor.depth[p]) continue;
      size_t at = seen++;
      for (; at > 0 && layers[order[at - 1]].picture.depth[p] < depth; --at)
        order[at] = order[at - 1];
      order[at] = k;
    }
    double thinned = 1.0;
    for (size_t i = 0; i < seen; ++i) {
      const LayerPicture& layer = layers[order[i]];
      const bool solid = layer.opacity >= 1.0;
      const double share = solid ? 1.0 : layer.opacity * thinned;
      blend(&floor.rgba[4 * p], &layer.picture.rgba[4 * p],
            static_cast<int>(std::lround(256.0 * share)));
      if (solid) thinned = thinning;
    }
  }
}

Image shrunk(const Rendered& large) {
  static_assert(oversampling == 2);
  Image image(large.width / 2, large.height / 2);
  const size_t rowBytes = 4 * static_cast<size_t>(large.width);
  for (int y = 0; y < image.height; ++y) {
    const uint8_t* a = large.rgba.data() + 2 * static_cast<size_t>(image.height - 1 - y) * rowBytes;
    const uint8_t* b = a + rowBytes;
    uint8_t* to = image.at(0, y);
    for (int x = 0; x < image.width; ++x, a += 8, b += 8, to += 4) {
      for (int c = 0; c < 3; ++c)
        to[c] = static_cast<uint8_t>((a[c] + a[c + 4] + b[c] + b[c + 4] + 2) / 4);
    }
  }
  return image;
}

}  // namespace marey::render

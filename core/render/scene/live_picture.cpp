#include "render/scene/live_picture.h"

#include <algorithm>

#include "render/scene/offscreen.h"

namespace marey::render {

struct LivePicture::Internals {
  OffscreenWindow window;
};

LivePicture::LivePicture() : m_internals(std::make_unique<Internals>()) {}
LivePicture::~LivePicture() = default;
LivePicture::LivePicture(LivePicture&&) noexcept = default;
LivePicture& LivePicture::operator=(LivePicture&&) noexcept = default;

Image LivePicture::take(const LiveScene& scene, int width, int height) {
  const Rendered drawn = m_internals->window.render(scene.renderer(), width, height);
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    const uint8_t* row = drawn.rgba.data() + 4 * static_cast<size_t>(height - 1 - y) * width;
    std::copy_n(row, 4 * static_cast<size_t>(width), image.at(0, y));
  }
  for (size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
  return image;
}

void LivePicture::draw(const LiveScene& scene, int width, int height) {
  m_internals->window.draw(scene.renderer(), width, height);
}

}  // namespace marey::render

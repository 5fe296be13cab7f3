#include "render/scene/scene_picture.h"

#include <algorithm>

#include "render/scene/offscreen.h"

namespace marey::render {

struct ScenePicture::Internals {
  OffscreenWindow window;
};

ScenePicture::ScenePicture() : m_internals(std::make_unique<Internals>()) {}
ScenePicture::~ScenePicture() = default;
ScenePicture::ScenePicture(ScenePicture&&) noexcept = default;
ScenePicture& ScenePicture::operator=(ScenePicture&&) noexcept = default;

Image ScenePicture::take(const Scene& scene, int width, int height) {
  const Rendered drawn = m_internals->window.render(scene.renderer(), width, height);
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    const uint8_t* row = drawn.rgba.data() + 4 * static_cast<size_t>(height - 1 - y) * width;
    std::copy_n(row, 4 * static_cast<size_t>(width), image.at(0, y));
  }
  for (size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
  return image;
}

void ScenePicture::draw(const Scene& scene, int width, int height) {
  m_internals->window.draw(scene.renderer(), width, height);
}

}  // namespace marey::render

// A scene drawn without a window: for pictures, for tests and for measuring its speed.
#pragma once

#include <memory>

#include "render/base/image.h"
#include "render/scene/scene.h"

namespace marey::render {

/// Holds an OpenGL context without a display. A scene is shown by one ScenePicture or window at a
/// time; which of them ends first does not matter.
class ScenePicture {
 public:
  /// Throws Error where no OpenGL without a display is to be had.
  ScenePicture();
  ~ScenePicture();
  ScenePicture(ScenePicture&&) noexcept;
  ScenePicture& operator=(ScenePicture&&) noexcept;

  /// The scene as a window of this size shows it; opaque RGBA.
  Image take(const Scene& scene, int width, int height);
  /// Draws as a window does and waits until it is done, without making a picture.
  void draw(const Scene& scene, int width, int height);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render

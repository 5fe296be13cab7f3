// A moving scene drawn without a window: for pictures, for tests and for measuring its speed.
#pragma once

#include <memory>

#include "render/base/image.h"
#include "render/scene/live_scene.h"

namespace marey::render {

/// Holds an OpenGL context without a display. A scene is shown by one LivePicture or window at a
/// time; which of them ends first does not matter.
class LivePicture {
 public:
  /// Throws Error where no OpenGL without a display is to be had.
  LivePicture();
  ~LivePicture();
  LivePicture(LivePicture&&) noexcept;
  LivePicture& operator=(LivePicture&&) noexcept;

  /// The scene as a window of this size shows it; opaque RGBA.
  Image take(const LiveScene& scene, int width, int height);
  /// Draws as a window does and waits until it is done, without making a picture.
  void draw(const LiveScene& scene, int width, int height);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render

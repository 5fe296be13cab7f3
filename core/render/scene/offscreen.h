// Private to the folder: a VTK render window without any display.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <vtkRenderer.h>

namespace marey::render {

/// One picture; rows from the bottom, as OpenGL stores them.
struct Rendered {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  ///< height x width x 4
};

/// A surfaceless EGL context and a window on it. The context is current only inside `render`, so
/// an object may be used from one thread after another, but not from two at once.
class OffscreenWindow {
 public:
  /// Throws Error, naming the step, where no OpenGL 3.2 without a display is to be had.
  OffscreenWindow();
  ~OffscreenWindow();
  OffscreenWindow(const OffscreenWindow&) = delete;
  OffscreenWindow& operator=(const OffscreenWindow&) = delete;

  /// Draws a renderer at this size, without anti-aliasing. The renderer is kept, with what it has
  /// on the graphics side, until another one or the end of the window.
  Rendered render(vtkRenderer* renderer, int width, int height);
  /// The same without reading the picture back; returns once it is really drawn.
  void draw(vtkRenderer* renderer, int width, int height);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render

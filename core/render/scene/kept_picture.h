// Private to the folder: the pixels of a view, kept from one drawing to the next, so that what is
// costly and does not change is drawn once and then copied.
#pragma once

#include <array>
#include <cstdint>

#include <vtkOpenGLFramebufferObject.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

class vtkOpenGLRenderWindow;

namespace marey::render {

/// Everything on which pixels depend.
struct PictureKey {
  std::array<double, 16> projection{};  ///< world to clip space
  std::array<double, 3> background{};
  std::array<int, 4> viewport{};  ///< left, low, width, height in the window, pixels
  std::array<int, 2> window{};    ///< width, height, pixels
  uint64_t look = 0;              ///< of what is drawn, by any numbering

  static PictureKey of(vtkRenderer* renderer, uint64_t look);
  bool operator==(const PictureKey&) const = default;
};

/// Lives in the OpenGL context of a window; used while the window draws.
class KeptPicture {
 public:
  bool holds(const PictureKey& key) const { return m_kept && key == m_last; }
  /// Copies the colours and depths that are held into the view.
  void restore(vtkRenderer* renderer) const;
  /// Keeps what the view shows, at the second drawing under a key: while a camera moves, nothing
  /// is ever restored and keeping would cost time. Windows with multisampling are left alone.
  void keep(vtkRenderer* renderer, const PictureKey& key);
  /// To be called while the context is there, when it or the window goes.
  void release(vtkWindow* window);

 private:
  bool take(vtkOpenGLRenderWindow* window);
  bool makeRoom(vtkOpenGLRenderWindow* window);

  vtkSmartPointer<vtkOpenGLFramebufferObject> m_pixels =
      vtkSmartPointer<vtkOpenGLFramebufferObject>::New();
  PictureKey m_last;
  bool m_drawn = false, m_kept = false;  ///< whether m_last was drawn, and is kept
  bool m_refused = false;                ///< the window's pixels cannot be copied
};

}  // namespace marey::render

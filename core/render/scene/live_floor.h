// Private to the folder: the floor of a moving scene, a grid that fades into the distance, worked
// out per pixel, with the shadows on it.
#pragma once

#include <memory>

#include <vtkRenderer.h>

#include "render/base/colours.h"
#include "render/scene/soft_shadow.h"

namespace marey::render {

/// The colours of a scene on light or on dark.
struct Backdrop {
  Colour background, floor, line, ink;
  double shadow = 1.0;  ///< how much of a shadow is seen
};
const Backdrop& backdropOf(bool dark);

class LiveFloor {
 public:
  explicit LiveFloor(vtkRenderer* renderer);
  ~LiveFloor();
  LiveFloor(const LiveFloor&) = delete;
  LiveFloor& operator=(const LiveFloor&) = delete;

  void setVisible(bool visible);
  /// The floor reaches `radiusM` around a point; its outer half fades.
  void setPlace(double x, double z, double radiusM);
  void setLook(const Backdrop& backdrop, double gridM);
  void setShadows(const ShadowMap& map);
  /// At the start of every drawing, when the camera is as it will be drawn. While neither it nor
  /// the floor changes, the floor is copied from an earlier drawing: true.
  bool prepare(vtkRenderer* renderer);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render

// Private to the folder: the floor of a scene, a grid that fades into the distance, worked
// out per pixel, with the shadows on it.
#pragma once

#include <memory>

#include <vtkRenderer.h>

#include "render/scene/backdrop.h"
#include "render/scene/soft_shadow.h"

namespace marey::render {

class SceneFloor {
 public:
  explicit SceneFloor(vtkRenderer* renderer);
  ~SceneFloor();
  SceneFloor(const SceneFloor&) = delete;
  SceneFloor& operator=(const SceneFloor&) = delete;

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

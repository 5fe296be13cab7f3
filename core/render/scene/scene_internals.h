// Private to the folder: what a Scene holds. What is shown and where is the stage's; here are the
// camera, the renderer and what has to be done anew.
#pragma once

#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "render/scene/scene_batches.h"
#include "render/scene/scene_floor.h"

namespace marey::render {

struct Scene::Internals {
  Internals();
  ~Internals();
  Internals(const Internals&) = delete;
  Internals& operator=(const Internals&) = delete;

  Stage stage;
  bool following = false;
  Vec3 followed = Vec3::Zero();        ///< the place on the floor that the camera is tied to
  Eigen::Vector2f slant{0.34F, 0.2F};  ///< of the light that casts the shadows

  vtkSmartPointer<vtkRenderer> renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkCamera> eye = vtkSmartPointer<vtkCamera>::New();
  SceneFloor floor{renderer};
  SceneBatches batches{renderer};
  SceneStrokes strokes;
  SceneCost cost;

  Camera camera() const;
  void apply(const Camera& camera);
  void turnTo(const ViewAxes& axes);
  void stageChanged();
  void draw();  ///< before OpenGL

  bool sceneChanged = true, timeChanged = true;  ///< since the last drawing

 private:
  void fill();
  void show(const Camera& from, bool moved);
  void setClipping(const Camera& from);
  void castShadows();

  vtkMTimeType m_seenFrom = 0;    ///< the camera of the last drawing
  std::array<int, 4> m_seenIn{};  ///< its viewport; see StrokeView
  bool m_thinStrokes = true;      ///< what its window draws; without, lines are plain ones
  ShadowMap m_shadowMap;
  unsigned long m_observer = 0;
};

}  // namespace marey::render

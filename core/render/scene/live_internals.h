// Private to the folder: what a LiveScene holds. The work is split over live_scene.cpp (what the
// user sets), live_drawing.cpp (what is done before a drawing) and live_camera.cpp.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "render/scene/live_figures.h"
#include "render/scene/live_floor.h"
#include "render/scene/live_scene.h"
#include "render/scene/live_tracks.h"
#include "render/scene/strokes.h"

namespace marey::render {

/// A ball around everything that is ever shown, and a cylinder for the floor.
struct SceneExtent {
  Vec3 centre{0.0F, 0.9F, 0.0F};
  float radius = 2.0F;
  float floorRadius = 2.0F;
};

struct LiveScene::Internals {
  Internals();
  ~Internals();
  Internals(const Internals&) = delete;
  Internals& operator=(const Internals&) = delete;

  std::vector<LiveMotion> motions;
  std::vector<std::shared_ptr<Track>> tracks;  ///< one per motion
  LiveOptions options;
  double time = 0.0;
  bool following = false;
  Vec3 followed = Vec3::Zero();        ///< the place on the floor that the camera is tied to
  Eigen::Vector2f slant{0.34F, 0.2F};  ///< of the light that casts the shadows

  vtkSmartPointer<vtkRenderer> renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkCamera> eye = vtkSmartPointer<vtkCamera>::New();
  // In the order of drawing.
  LiveFloor floor{renderer};
  StrokeBatch decals{renderer, StrokeLook::Flat}, solid{renderer, StrokeLook::Limbs};
  StrokeBatch lines{renderer, StrokeLook::Thin}, plainLines{renderer, StrokeLook::Flat};
  StrokeBatch trails{renderer, StrokeLook::Flat};
  StrokeBatch ghostLines{renderer, StrokeLook::Thin}, plainGhostLines{renderer, StrokeLook::Flat};
  StrokeBatch ghosts{renderer, StrokeLook::Limbs, 8}, sheer{renderer, StrokeLook::Limbs, 8};
  FigureStrokes solidFigures, sheerFigures, lineFigures, ghostFigures, trailStrokes, decalStrokes;
  std::vector<ShadowLimb> shadowLimbs;
  ShadowMap shadowMap;

  bool sceneChanged = true, timeChanged = true;  ///< since the last drawing
  bool posesCurrent = false;
  bool someHighlighted = false;
  vtkMTimeType seenFrom = 0;    ///< the camera of the last drawing
  std::array<int, 4> seenIn{};  ///< its viewport; see StrokeView
  bool thinStrokes = true;      ///< what its window draws; without, lines are plain ones
  SceneExtent extent;
  std::vector<Vec3> poses;      ///< of every motion at `time`, one after the other
  std::vector<size_t> offsets;  ///< first joint of each motion
  LiveCost cost;

  std::span<const Vec3> poseOf(size_t motion);
  bool useLines() const;
  double longestS() const;
  bool marksInPlace() const { return options.placement != Placement::RootAligned; }
  Colour shownColour(size_t motion, double timeS) const;
  void updatePoses();
  void updateExtent();
  std::vector<Vec3> outline(bool relativeToFollowed) const;
  Vec3 meanRoot(double timeS) const;
  void followNow();
  Camera camera() const;
  void apply(const Camera& camera);

  void draw();  ///< before OpenGL
  void fillFigures();
  void fillGhosts();
  void addHighlightBall(FigureStrokes& figures, size_t motion);
  void fillTrails();
  void fillDecals();
  void fillShadows();
  void showStrokes(const Camera& from);
  void showGhosts(const Camera& from);
  void setViews();
  void setClipping(const Camera& from);

 private:
  unsigned long m_observer = 0;
};

}  // namespace marey::render

// The 3D view: all visible motions on one clock, with mouse and keys.
#pragma once

#include <QTimer>
#include <memory>

#include "gui/path/current_path.h"
#include "gui/scene/floor_path_tool.h"
#include "gui/scene/scene_content.h"
#include "gui/scene/scene_overlay.h"
#include "gui/scene/shown_scene.h"
#include <QVTKOpenGLNativeWidget.h>

#include "render/scene/scene.h"

namespace marey::gui {

/// Redraws at most once per turn of the event loop, whatever changes meanwhile.
class SceneView : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  /// Keeps `shown` as it is seen.
  SceneView(Workspace& workspace, std::shared_ptr<ShownScene> shown, QWidget* parent);
  /// Before the application starts: the OpenGL and the windows that every view asks for.
  static void prepareApplication();
  ~SceneView() override;

  const SceneSettings& settings() const { return m_settings; }
  void setSettings(const SceneSettings& settings);
  render::Scene& scene() { return m_scene; }
  void setView(render::View view);
  void fit();
  /// Where the camera is, and back there; it then stays while motions come and go.
  CameraPose camera() const;
  void setCamera(const CameraPose& pose);
  /// Whether somebody chose where the camera is.
  bool cameraChosen() const { return m_cameraMoved || m_cameraKept; }
  /// Another document: motions choose the view again.
  void releaseCamera();
  void setFollow(bool follow);
  void setOrthographic(bool orthographic);
  void setPathEditing(bool editing);
  void removeWayPoint();
  Workspace& workspace() { return m_workspace; }
  /// The motions that are drawn and may be picked, in the scene's order.
  const SceneContent& content() const { return m_content; }
  /// What an empty view says.
  QString hint() const { return m_overlay->hint(); }

 Q_SIGNALS:
  /// The settings are no longer those that were asked for: a placement could not be drawn.
  void settingsReplaced();

 protected:
  bool event(QEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  enum class Drag { None, Undecided, Orbit, Pan, WayPoint };
  void connectWorkspace();
  void changeMotions();
  void changeOptions();
  void schedule();
  void flush();
  void updateMotions();
  void updateOptions();
  void fitNew();
  void updateHint();
  void tellShown();
  void scoreNatural();
  void fallBack(const std::string& why);
  void updateHover();
  void pick(const QPointF& at, bool add);

  Workspace& m_workspace;
  render::Scene m_scene;
  CurrentPath* m_path = nullptr;
  FloorPathTool m_tool;
  SceneSettings m_settings;
  SceneContent m_content;
  MotionColouring* m_colouring = nullptr;
  std::shared_ptr<ShownScene> m_shown;
  SceneOverlay* m_overlay = nullptr;
  QTimer m_hover;
  bool m_redrawPosted = false;
  bool m_motionsChanged = true, m_optionsChanged = true;
  bool m_cameraMoved = false;  ///< by the user, who then keeps it
  bool m_cameraKept = false;   ///< as the document or a slot says
  size_t m_fittedMotions = 0;
  bool m_fittedPath = false;
  QString m_trouble;  ///< why a choice could not be drawn
  Drag m_drag = Drag::None;
  QPointF m_pressedAt, m_mouse;
};

}  // namespace marey::gui

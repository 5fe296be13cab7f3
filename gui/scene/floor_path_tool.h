// Editing the current path on the floor of the 3D view: discs that are dragged, and a knob before
// the chosen one that turns where the body faces.
#pragma once

#include <QPainter>
#include <optional>
#include <vector>

#include "gui/common/paint_style.h"
#include "gui/path/current_path.h"

#include "render/scene/scene.h"

namespace marey::gui {

/// Positions are in pixels of a view `size`.
class FloorPathTool {
 public:
  FloorPathTool(CurrentPath& path, const render::Scene& scene) : m_path(path), m_scene(scene) {}

  void setActive(bool active);
  bool active() const { return m_active; }

  /// Takes hold of the way-point or knob under the mouse; false where there is none.
  bool press(const QPointF& at, const QSize& size);
  void drag(const QPointF& to, const QSize& size);
  void release() { m_held = Held::Nothing; }
  bool add(const QPointF& at, const QSize& size);
  void removeChosen();
  void paint(QPainter& painter, const QSize& size, const Inks& inks) const;

 private:
  enum class Held { Nothing, WayPoint, Facing };
  std::optional<size_t> wayPointAt(const QPointF& at, const QSize& size) const;
  /// Where the chosen way-point's knob is seen; none where none is chosen.
  std::optional<QPointF> knob(const QSize& size) const;
  QPointF seen(double x, double z, const QSize& size) const;
  void paintKnob(QPainter& painter, const QSize& size, const Inks& inks) const;
  QPolygonF disc(const WayPoint& point, double radiusM, const QSize& size) const;

  CurrentPath& m_path;
  const render::Scene& m_scene;
  /// Forgets a choice that was made on another path.
  void followPath();

  bool m_active = false, m_moved = false;
  Held m_held = Held::Nothing;
  std::string m_pathName;
  std::optional<size_t> m_chosen;
};

}  // namespace marey::gui

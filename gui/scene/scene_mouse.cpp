// The 3D view's mouse: left drag turns, middle or Shift drag shifts, the wheel zooms, a click
// chooses.
#include <QMouseEvent>
#include <QWheelEvent>
#include <cmath>

#include "gui/scene/scene_view.h"

namespace marey::gui {
namespace {

/// From press to release, to be still a click.
constexpr double kClickPixels = 4.0;
constexpr double kRadPerPixel = 0.008;

QPointF placeOf(const QMouseEvent* event) {
  return event->localPos();
}

}  // namespace

bool SceneView::event(QEvent* event) {
  // VTK's adapter would take keys and the mouse for its own interactor.
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
    case QEvent::Wheel:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::Enter:
    case QEvent::Leave:
      return QOpenGLWidget::event(event);
    default:
      return QVTKOpenGLNativeWidget::event(event);
  }
}

void SceneView::changeEvent(QEvent* event) {
  QVTKOpenGLNativeWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) changeOptions();
}

void SceneView::resizeEvent(QResizeEvent* event) {
  QVTKOpenGLNativeWidget::resizeEvent(event);
  m_overlay->setGeometry(rect());
  schedule();
}

void SceneView::showEvent(QShowEvent* event) {
  QVTKOpenGLNativeWidget::showEvent(event);
  schedule();
}

void SceneView::leaveEvent(QEvent* event) {
  QVTKOpenGLNativeWidget::leaveEvent(event);
  m_hover.stop();
  m_overlay->setHover({}, {});
}

void SceneView::mousePressEvent(QMouseEvent* event) {
  m_pressedAt = m_mouse = placeOf(event);
  m_overlay->setHover({}, {});
  const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && shift))
    m_drag = Drag::Pan;
  else if (event->button() != Qt::LeftButton)
    m_drag = Drag::None;
  else if (m_tool.active() && m_tool.press(m_pressedAt, size()))
    m_drag = Drag::WayPoint;
  else
    m_drag = Drag::Undecided;
  schedule();
  event->accept();
}

void SceneView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = placeOf(event);
  const QPointF moved = at - m_mouse;
  if (m_drag == Drag::Undecided) {
    const QPointF whole = at - m_pressedAt;
    if (std::hypot(whole.x(), whole.y()) < kClickPixels) return;
    m_drag = Drag::Orbit;
  }
  m_mouse = at;
  if (m_drag == Drag::None) {
    if (!m_hover.isActive()) m_hover.start();
    return;
  }
  if (m_drag != Drag::WayPoint) m_cameraMoved = true;
  if (m_drag == Drag::WayPoint)
    m_tool.drag(at, size());
  else if (m_drag == Drag::Pan)
    m_scene.pan(moved.x(), moved.y(), height());
  else
    m_scene.orbit(-kRadPerPixel * moved.x(), kRadPerPixel * moved.y());
  schedule();
}

void SceneView::mouseReleaseEvent(QMouseEvent* event) {
  const Drag drag = m_drag;
  m_drag = Drag::None;
  m_tool.release();
  if (drag == Drag::Undecided) pick(m_pressedAt, event->modifiers().testFlag(Qt::ControlModifier));
  schedule();
}

void SceneView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !m_tool.active()) return mousePressEvent(event);
  m_tool.add(placeOf(event), size());
  schedule();
}

void SceneView::wheelEvent(QWheelEvent* event) {
  m_cameraMoved = true;
  m_scene.zoom(std::pow(1.15, event->angleDelta().y() / 120.0));
  schedule();
  event->accept();
}

void SceneView::pick(const QPointF& at, bool add) {
  const auto hit = m_scene.pick(at.x(), at.y(), width(), height());
  if (!hit || hit->motion >= m_content.ids.size()) {
    if (!add) m_workspace.view().select({});
    return;
  }
  const MotionId& id = m_content.ids[hit->motion];
  Selection selection;
  if (add) selection = m_workspace.view().selection();
  // A second Ctrl-click on a motion takes it out again.
  if (!add || selection.motions.erase(id) == 0) selection.motions.insert(id);
  // The selection counts joints in the first motion's body, which may be another one.
  const auto& names = m_content.motions[hit->motion].clip->skeleton->names;
  const auto first = m_workspace.motions().skeleton();
  const int joint = first ? first->find(names[static_cast<size_t>(hit->joint)]) : -1;
  selection.joint = joint >= 0 ? std::optional(joint) : std::nullopt;
  m_workspace.view().select(selection);
}

void SceneView::updateHover() {
  const auto hit = m_scene.pick(m_mouse.x(), m_mouse.y(), width(), height());
  QString text;
  if (hit && hit->motion < m_content.ids.size()) {
    const render::SceneMotion& motion = m_content.motions[hit->motion];
    const auto& names = motion.clip->skeleton->names;
    text = QString::fromStdString(motion.label);
    if (hit->joint >= 0 && hit->joint < static_cast<int>(names.size()))
      text +=
          QStringLiteral(" · ") + QString::fromStdString(names[static_cast<size_t>(hit->joint)]);
  }
  m_overlay->setHover(text, m_mouse.toPoint());
}

}  // namespace marey::gui

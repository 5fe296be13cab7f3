#include "gui/scene/floor_path_tool.h"

#include <QCoreApplication>
#include <cmath>
#include <numbers>

namespace marey::gui {
namespace {

constexpr double kReachPixels = 16.0;
constexpr double kDiscM = 0.11;
constexpr double kKnobM = 0.6;  ///< from its way-point
constexpr double kKnobPixels = 5.0;

QString tr(const char* text) {
  return QCoreApplication::translate("FloorPathTool", text);
}

}  // namespace

void FloorPathTool::setActive(bool active) {
  m_active = active;
  m_held = Held::Nothing;
  m_chosen.reset();
}

QPointF FloorPathTool::seen(double x, double z, const QSize& size) const {
  const auto at = m_scene.screenPoint({static_cast<float>(x), 0.0F, static_cast<float>(z)},
                                      size.width(), size.height());
  return {at.x, at.y};
}

std::optional<QPointF> FloorPathTool::knob(const QSize& size) const {
  if (!m_chosen || *m_chosen >= m_path.points().size() || m_path.path()->name != m_pathName)
    return std::nullopt;
  const WayPoint& point = m_path.points()[*m_chosen];
  const double heading = m_path.headingAt(*m_chosen);
  return seen(point.x + kKnobM * std::sin(heading), point.z + kKnobM * std::cos(heading), size);
}

std::optional<size_t> FloorPathTool::wayPointAt(const QPointF& at, const QSize& size) const {
  std::optional<size_t> best;
  double nearest = kReachPixels;
  const auto& points = m_path.points();
  for (size_t i = 0; i < points.size(); ++i) {
    const QPointF off = seen(points[i].x, points[i].z, size) - at;
    const double away = std::hypot(off.x(), off.y());
    if (away < nearest) {
      nearest = away;
      best = i;
    }
  }
  return best;
}

void FloorPathTool::followPath() {
  const std::string name = m_path.path() ? m_path.path()->name : std::string();
  if (name != m_pathName || (m_chosen && *m_chosen >= m_path.points().size())) m_chosen.reset();
  m_pathName = name;
}

bool FloorPathTool::press(const QPointF& at, const QSize& size) {
  followPath();
  m_held = Held::Nothing;
  m_moved = false;
  if (!m_active) return false;
  const auto turned = knob(size);
  const auto found = wayPointAt(at, size);
  // From afar the knob lies on its way-point, which then is what is meant.
  if (turned && std::hypot(turned->x() - at.x(), turned->y() - at.y()) < kReachPixels && !found) {
    m_held = Held::Facing;
  } else if (found) {
    m_held = Held::WayPoint;
    m_chosen = found;
  }
  return m_held != Held::Nothing;
}

void FloorPathTool::drag(const QPointF& to, const QSize& size) {
  if (m_held == Held::Nothing || !m_chosen || *m_chosen >= m_path.points().size()) return;
  const auto place = m_scene.floorPoint(to.x(), to.y(), size.width(), size.height());
  // Near the horizon a pixel is hundreds of metres.
  if (!place || place->norm() > 1000.0F) return;
  const size_t index = *m_chosen;
  if (m_held == Held::Facing)
    m_path.edit(
        tr("Facing at way-point"),
        [&](PathEdit& edit) { edit.face(index, place->x(), place->z()); }, m_moved);
  else
    m_path.edit(
        tr("Move way-point"), [&](PathEdit& edit) { edit.move(index, place->x(), place->z()); },
        m_moved);
  m_moved = true;
}

bool FloorPathTool::add(const QPointF& at, const QSize& size) {
  followPath();
  const auto place = m_scene.floorPoint(at.x(), at.y(), size.width(), size.height());
  if (!m_active || !place || place->norm() > 1000.0F || wayPointAt(at, size)) return false;
  m_path.edit(tr("Add way-point"),
              [&](PathEdit& edit) { m_chosen = edit.add(place->x(), place->z()); });
  return true;
}

void FloorPathTool::removeChosen() {
  followPath();
  if (!m_active || !m_chosen) return;
  const size_t index = *m_chosen;
  m_chosen.reset();
  m_path.edit(tr("Remove way-point"), [index](PathEdit& edit) { edit.remove(index); });
}

QPolygonF FloorPathTool::disc(const WayPoint& point, double radiusM, const QSize& size) const {
  QPolygonF out;
  for (int k = 0; k < 24; ++k) {
    const double a = k * 2.0 * std::numbers::pi / 24;
    out << seen(point.x + radiusM * std::cos(a), point.z + radiusM * std::sin(a), size);
  }
  return out;
}

void FloorPathTool::paintKnob(QPainter& painter, const QSize& size, const Inks& inks) const {
  const auto at = knob(size);
  if (!at) return;
  const WayPoint& point = m_path.points()[*m_chosen];
  // Hollow where the body faces along the path.
  painter.setPen(QPen(inks.text, 2.0));
  painter.setBrush(point.facing ? QBrush(inks.text) : QBrush(inks.background));
  painter.drawLine(seen(point.x, point.z, size), *at);
  painter.drawEllipse(*at, kKnobPixels, kKnobPixels);
}

void FloorPathTool::paint(QPainter& painter, const QSize& size, const Inks& inks) const {
  if (!m_active) return;
  const auto& points = m_path.points();
  painter.setRenderHint(QPainter::Antialiasing);
  paintKnob(painter, size, inks);
  for (size_t i = 0; i < points.size(); ++i) {
    const bool chosen = m_chosen == i && m_path.path()->name == m_pathName;
    // Open discs stand for way-points that the path will get when it is edited.
    QColor fill = inks.accent;
    fill.setAlpha(m_path.drawn() || chosen ? (chosen ? 255 : 150) : 0);
    painter.setPen(QPen(chosen ? inks.text : inks.accent, chosen ? 2.5 : 2.0));
    painter.setBrush(fill);
    const QPolygonF shape = disc(points[i], kDiscM, size);
    painter.drawPolygon(shape);
    painter.setPen(inks.text);
    painter.drawText(shape.boundingRect().topRight() + QPointF(4, 0), QString::number(i + 1));
  }
}

}  // namespace marey::gui

#include "panels/floor_path_tool.h"

#include <QCoreApplication>
#include <cmath>
#include <numbers>

namespace marey::gui {
namespace {

constexpr double kReachPixels = 16.0;
constexpr double kDiscM = 0.11;

QString tr(const char* text) {
  return QCoreApplication::translate("FloorPathTool", text);
}

}  // namespace

void FloorPathTool::setActive(bool active) {
  m_active = active;
  m_held = false;
  m_chosen.reset();
}

std::optional<size_t> FloorPathTool::wayPointAt(const QPointF& at, const QSize& size) const {
  std::optional<size_t> best;
  double nearest = kReachPixels;
  const auto& points = m_path.points();
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 place(static_cast<float>(points[i].x), 0.0F, static_cast<float>(points[i].z));
    const auto seen = m_scene.screenPoint(place, size.width(), size.height());
    const double away = std::hypot(seen.x - at.x(), seen.y - at.y());
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
  const auto found = wayPointAt(at, size);
  m_held = m_active && found.has_value();
  m_moved = false;
  if (m_held) m_chosen = found;
  return m_held;
}

void FloorPathTool::drag(const QPointF& to, const QSize& size) {
  if (!m_held || !m_chosen) return;
  const auto place = m_scene.floorPoint(to.x(), to.y(), size.width(), size.height());
  // Near the horizon a pixel is hundreds of metres.
  if (!place || place->norm() > 1000.0F) return;
  m_path.edit(
      tr("Move way-point"),
      [&](PathEdit& edit) {
        if (*m_chosen < edit.size()) edit.move(*m_chosen, place->x(), place->z());
      },
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
    const Vec3 place(static_cast<float>(point.x + radiusM * std::cos(a)), 0.0F,
                     static_cast<float>(point.z + radiusM * std::sin(a)));
    const auto seen = m_scene.screenPoint(place, size.width(), size.height());
    out << QPointF(seen.x, seen.y);
  }
  return out;
}

void FloorPathTool::paint(QPainter& painter, const QSize& size, const Inks& inks) const {
  if (!m_active) return;
  const auto& points = m_path.points();
  painter.setRenderHint(QPainter::Antialiasing);
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

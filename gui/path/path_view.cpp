#include "gui/path/path_view.h"

#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace marey::gui {
namespace {

constexpr double kReachPixels = 11.0;
constexpr double kEdgePixels = 34.0;
constexpr double kKnobPixels = 30.0;                 ///< from its way-point
constexpr double kNearest = 400.0, kFurthest = 2.0;  ///< pixels per metre

}  // namespace

PathView::PathView(Workspace& workspace, CurrentPath& path, QWidget* parent)
    : QWidget(parent), m_workspace(workspace), m_path(path) {
  setObjectName(QStringLiteral("pathView"));
  setAccessibleName(tr("The path from above"));
  setMinimumSize(200, 160);
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setFont(readableFont(font()));
  setToolTip(tr(
      "Drag a way-point to move it, the knob of the chosen one to turn the body; double-click to "
      "add one; Delete removes the chosen one. Drag the floor to shift, wheel to zoom."));
  connect(&path, &CurrentPath::changed, this, &PathView::pathChanged);
  connect(&workspace.view(), &View::timeChanged, this, qOverload<>(&QWidget::update));
  pathChanged();
}

void PathView::setNatural(const std::optional<PaceRange>& natural) {
  m_natural = natural;
  m_strains = strainsOf(m_path.curve(), m_natural);
  update();
}

void PathView::choose(std::optional<size_t> index) {
  if (index && *index >= m_path.points().size()) index.reset();
  if (index == m_chosen) return;
  m_chosen = index;
  update();
  Q_EMIT chosenChanged();
}

void PathView::removeChosen() {
  if (!m_chosen || *m_chosen >= m_path.points().size()) return;
  const size_t index = *m_chosen;
  m_path.edit(tr("Remove way-point"), [index](PathEdit& edit) { edit.remove(index); });
}

void PathView::pathChanged() {
  m_strains = strainsOf(m_path.curve(), m_natural);
  const std::string name = m_path.path() ? m_path.path()->name : std::string();
  if (name != m_shownName) {
    m_shownName = name;
    m_touched = false;
    choose(std::nullopt);
  }
  if (m_chosen && *m_chosen >= m_path.points().size()) choose(std::nullopt);
  // A view that follows every drag would run away under the mouse.
  if (!m_touched && m_drag == Drag::None) fit();
  update();
}

void PathView::fit() {
  double x0 = -0.5, x1 = 0.5, z0 = -0.5, z1 = 0.5;
  bool first = true;
  const auto take = [&](double x, double z) {
    x0 = first ? x : std::min(x0, x);
    x1 = first ? x : std::max(x1, x);
    z0 = first ? z : std::min(z0, z);
    z1 = first ? z : std::max(z1, z);
    first = false;
  };
  for (const RootFrame& frame : m_path.curve().frames) take(frame.x, frame.z);
  for (const WayPoint& point : m_path.points()) take(point.x, point.z);
  m_centre = {(x0 + x1) / 2, (z0 + z1) / 2};
  const double across = std::max(50.0, width() - 2 * kEdgePixels) / std::max(1.0, x1 - x0);
  const double up = std::max(50.0, height() - 2 * kEdgePixels) / std::max(1.0, z1 - z0);
  m_pixelsPerMetre = std::clamp(std::min(across, up), kFurthest, kNearest);
  m_touched = false;
  update();
}

QPointF PathView::toScreen(double x, double z) const {
  // Seen from above with +Z up the page, +X is on the left.
  return {width() / 2.0 - (x - m_centre.x()) * m_pixelsPerMetre,
          height() / 2.0 - (z - m_centre.y()) * m_pixelsPerMetre};
}

QPointF PathView::toFloor(const QPointF& screen) const {
  return {m_centre.x() - (screen.x() - width() / 2.0) / m_pixelsPerMetre,
          m_centre.y() - (screen.y() - height() / 2.0) / m_pixelsPerMetre};
}

std::optional<size_t> PathView::wayPointAt(const QPointF& at) const {
  std::optional<size_t> best;
  double nearest = kReachPixels;
  for (size_t i = 0; i < m_path.points().size(); ++i) {
    const WayPoint& point = m_path.points()[i];
    const QPointF away = toScreen(point.x, point.z) - at;
    if (std::hypot(away.x(), away.y()) >= nearest) continue;
    nearest = std::hypot(away.x(), away.y());
    best = i;
  }
  return best;
}

std::optional<QPointF> PathView::knob() const {
  if (!m_chosen || *m_chosen >= m_path.points().size()) return std::nullopt;
  const WayPoint& point = m_path.points()[*m_chosen];
  const double heading = m_path.headingAt(*m_chosen);
  return toScreen(point.x, point.z) + kKnobPixels * QPointF(-std::sin(heading), -std::cos(heading));
}

bool PathView::atKnob(const QPointF& at) const {
  const auto place = knob();
  return place && std::hypot(place->x() - at.x(), place->y() - at.y()) < kReachPixels;
}

void PathView::resizeEvent(QResizeEvent* /*event*/) {
  if (!m_touched) fit();
}

void PathView::mousePressEvent(QMouseEvent* event) {
  m_last = event->localPos();
  m_moved = false;
  const auto found = wayPointAt(m_last);
  if (event->button() == Qt::LeftButton && !found && atKnob(m_last)) {
    m_drag = Drag::Facing;
    return;
  }
  if (event->button() == Qt::LeftButton && found) {
    choose(found);
    m_drag = Drag::WayPoint;
    return;
  }
  if (event->button() == Qt::LeftButton) choose(std::nullopt);
  m_drag = Drag::Shift;
}

void PathView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->localPos();
  if (m_drag == Drag::None) {
    setCursor(wayPointAt(at) || atKnob(at) ? Qt::PointingHandCursor : Qt::ArrowCursor);
    return;
  }
  const QPointF moved = at - m_last;
  if (m_drag != Drag::Shift) {
    // A hand that trembles on a click does not edit.
    if (!m_moved && std::hypot(moved.x(), moved.y()) < 3.0) return;
    dragChosen(at);
  } else {
    m_centre += moved / m_pixelsPerMetre;
    m_touched = true;
    update();
  }
  m_last = at;
}

void PathView::dragChosen(const QPointF& to) {
  if (!m_chosen || *m_chosen >= m_path.points().size()) return;
  const QPointF place = toFloor(to);
  const size_t index = *m_chosen;
  if (m_drag == Drag::Facing)
    m_path.edit(
        tr("Facing at way-point"), [&](PathEdit& edit) { edit.face(index, place.x(), place.y()); },
        m_moved);
  else
    m_path.edit(
        tr("Move way-point"), [&](PathEdit& edit) { edit.move(index, place.x(), place.y()); },
        m_moved);
  m_moved = true;
}

void PathView::mouseReleaseEvent(QMouseEvent* /*event*/) {
  m_drag = Drag::None;
}

void PathView::mouseDoubleClickEvent(QMouseEvent* event) {
  m_drag = Drag::None;
  if (event->button() != Qt::LeftButton || wayPointAt(event->localPos())) return;
  const QPointF place = toFloor(event->localPos());
  const double reach = kReachPixels / m_pixelsPerMetre;
  std::optional<size_t> added;
  m_path.edit(tr("Add way-point"),
              [&](PathEdit& edit) { added = edit.add(place.x(), place.y(), reach); });
  choose(added);
}

void PathView::wheelEvent(QWheelEvent* event) {
  const double factor = std::pow(1.2, event->angleDelta().y() / 120.0);
  const QPointF at = event->position();
  const QPointF before = toFloor(at);
  m_pixelsPerMetre = std::clamp(m_pixelsPerMetre * factor, kFurthest, kNearest);
  // What is under the mouse stays there.
  m_centre += before - toFloor(at);
  m_touched = true;
  update();
  event->accept();
}

}  // namespace marey::gui

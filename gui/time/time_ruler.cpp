#include "gui/time/time_ruler.h"

#include <QMouseEvent>
#include <QPainter>
#include <QStyle>
#include <algorithm>
#include <cmath>

#include "render/chart/ticks.h"

namespace marey::gui {
namespace {

/// Room for the names of motions and feet.
constexpr double kNames = 190.0;
constexpr int kStrip = 10;
constexpr double kPixelsPerTick = 70.0;
/// A shorter drag is a click.
constexpr double kShortestPixels = 4.0;

}  // namespace

TimeRuler::TimeRuler(Workspace& workspace, QWidget* parent)
    : QWidget(parent), m_workspace(workspace) {
  setObjectName(QStringLiteral("timelineRuler"));
  setMouseTracking(true);
  setAccessibleName(tr("Time in seconds and frames"));
  setToolTip(
      tr("Drag to move in time. Shift drag, or drag on the strip, to choose a range; "
         "double-click the strip to drop it."));
  setFont(readableFont(font()));
  connect(&workspace.view(), &View::timeChanged, this, qOverload<>(&QWidget::update));
  connect(&workspace.view(), &View::rangeChanged, this, qOverload<>(&QWidget::update));
  connect(&workspace.motions(), &MotionGroups::visibilityChanged, this, &TimeRuler::updateAxis);
  connect(&workspace.motions(), &MotionGroups::changed, this, &TimeRuler::updateAxis);
  connect(&workspace.document(), &Document::changed, this, qOverload<>(&QWidget::update));
  updateAxis();
}

QSize TimeRuler::sizeHint() const {
  return {300, 2 * fontMetrics().height() + kStrip + 12};
}

int TimeRuler::stripTop() const {
  return height() - kStrip - 1;
}

void TimeRuler::updateAxis() {
  const int bar = style()->pixelMetric(QStyle::PM_ScrollBarExtent);
  const double seconds = m_workspace.motions().duration();
  // Room for a scroll bar below is kept at all times, so that nothing jumps when it appears.
  m_axis = {.left = std::min(kNames, width() * 0.3),
            .right = std::max(width() - bar - 2.0 * kMargin, width() * 0.3 + 10.0),
            .seconds = seconds > 0.0 ? seconds : 1.0};
  update();
  Q_EMIT axisChanged();
}

void TimeRuler::resizeEvent(QResizeEvent* /*event*/) {
  updateAxis();
}

void TimeRuler::paintTicks(QPainter& painter, const Inks& inks) const {
  const double fps = m_workspace.document().experiment().fps;
  const int wanted = std::max(2, static_cast<int>((m_axis.right - m_axis.left) / kPixelsPerTick));
  const render::Ticks ticks = render::niceTicks(0.0, m_axis.seconds, wanted);
  const int line = fontMetrics().height();
  const QFont small = painter.font();
  painter.setPen(inks.faintText);
  const QRectF names(kMargin, 2, m_axis.left - 2 * kMargin - 24, line);
  painter.drawText(names, Qt::AlignRight | Qt::AlignVCenter, tr("Seconds"));
  painter.drawText(names.translated(0, line + 1), Qt::AlignRight | Qt::AlignVCenter,
                   tr("Frame at %1 fps").arg(fps));
  for (size_t i = 0; i < ticks.values.size(); ++i) {
    const double x = m_axis.x(ticks.values[i]);
    painter.setPen(inks.strongGrid);
    painter.drawLine(QPointF(x, 2), QPointF(x, stripTop() - 1));
    painter.setPen(inks.text);
    const QRectF box(x + 4, 2, kPixelsPerTick, line);
    if (x + 30 > width()) continue;
    painter.drawText(box, Qt::AlignLeft | Qt::AlignVCenter,
                     QString::fromStdString(ticks.labels[i]));
    painter.setPen(inks.faintText);
    painter.drawText(box.translated(0, line + 1), Qt::AlignLeft | Qt::AlignVCenter,
                     QString::number(std::lround(ticks.values[i] * fps)));
  }
}

void TimeRuler::paintStrip(QPainter& painter, const Inks& inks) const {
  const QRectF strip(m_axis.left, stripTop(), m_axis.right - m_axis.left, kStrip);
  painter.fillRect(strip, inks.grid);
  if (const auto& range = m_workspace.view().range()) {
    QRectF part = strip;
    part.setLeft(m_axis.x(std::clamp(range->beginS, 0.0, m_axis.seconds)));
    part.setRight(m_axis.x(std::clamp(range->endS, 0.0, m_axis.seconds)));
    painter.fillRect(part, inks.accent);
  }
}

void TimeRuler::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  if (m_workspace.motions().duration() <= 0.0) return;
  paintTicks(painter, inks);
  paintStrip(painter, inks);
  painter.setRenderHint(QPainter::Antialiasing);
  const double x = m_axis.x(m_workspace.view().time());
  painter.setPen(QPen(inks.warning, 1.6));
  painter.drawLine(QPointF(x, 0), QPointF(x, height()));
  painter.setBrush(inks.warning);
  painter.drawPolygon(QPolygonF({QPointF(x - 5, 0), QPointF(x + 5, 0), QPointF(x, 8)}));
}

double TimeRuler::snapped(double x) const {
  const double fps = m_workspace.document().experiment().fps;
  const double seconds = std::clamp(m_axis.at(x), 0.0, m_axis.seconds);
  return std::min(std::round(seconds * fps) / fps, m_axis.seconds);
}

void TimeRuler::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || m_workspace.motions().duration() <= 0.0) return;
  const QPointF at = event->localPos();
  const bool range = event->modifiers().testFlag(Qt::ShiftModifier) || at.y() >= stripTop();
  m_drag = range ? Drag::Range : Drag::Time;
  m_anchorS = snapped(at.x());
  if (!range) m_workspace.view().setTime(m_anchorS);
}

void TimeRuler::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->localPos();
  setCursor(at.y() >= stripTop() ? Qt::SizeHorCursor : Qt::ArrowCursor);
  const double seconds = snapped(at.x());
  if (m_drag == Drag::Time) m_workspace.view().setTime(seconds);
  const bool far = std::abs(m_axis.x(m_anchorS) - at.x()) >= kShortestPixels;
  if (m_drag == Drag::Range && far && seconds != m_anchorS)
    m_workspace.view().setRange(
        TimeRange{std::min(m_anchorS, seconds), std::max(m_anchorS, seconds)});
}

void TimeRuler::mouseReleaseEvent(QMouseEvent* /*event*/) {
  m_drag = Drag::None;
}

void TimeRuler::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->localPos().y() >= stripTop())
    m_workspace.view().setRange(std::nullopt);
  else
    mousePressEvent(event);
}

}  // namespace marey::gui

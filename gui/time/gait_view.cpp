#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>

#include "gui/time/time_ruler.h"

#include "render/chart/ticks.h"

namespace marey::gui {

GaitView::GaitView(Workspace& workspace, const TimeRuler& ruler, QWidget* parent)
    : QWidget(parent), m_workspace(workspace), m_ruler(ruler) {
  setObjectName(QStringLiteral("timelineGait"));
  setAccessibleName(tr("Foot contacts over time"));
  setFont(readableFont(font()));
  connect(&workspace.view(), &View::timeChanged, this, qOverload<>(&QWidget::update));
  connect(&workspace.view(), &View::rangeChanged, this, qOverload<>(&QWidget::update));
  connect(&ruler, &TimeRuler::axisChanged, this, qOverload<>(&QWidget::update));
}

int GaitView::rowHeight() const {
  return fontMetrics().height() + 3;
}

void GaitView::setRows(std::vector<GaitRow> rows, int leftOut) {
  m_rows = std::move(rows);
  m_leftOut = leftOut;
  const int lines = static_cast<int>(m_rows.size()) + (leftOut > 0 ? 1 : 0);
  setMinimumHeight(lines * rowHeight() + 2 * kSpacing);
  update();
}

void GaitView::setHint(const QString& hint) {
  m_hint = hint;
  update();
}

void GaitView::paintRow(QPainter& painter, const Inks& inks, const GaitRow& row,
                        const QRectF& rect) const {
  const TimeAxis& axis = m_ruler.axis();
  const QFontMetrics metrics = painter.fontMetrics();
  if (row.first) {
    painter.setPen(inks.grid);
    painter.drawLine(rect.topLeft(), rect.topRight());
  }
  const double names = axis.left - 2 * kMargin;
  painter.setPen(inks.text);
  const QRectF whole(kMargin, rect.top(), names, rect.height());
  const QString foot = metrics.elidedText(row.foot, Qt::ElideMiddle, static_cast<int>(names * 0.5));
  painter.drawText(whole, Qt::AlignRight | Qt::AlignVCenter, foot);
  if (row.first) {
    const QColor ink = shownColour(row.colour, isDark(palette()));
    painter.setPen(Qt::NoPen);
    painter.setBrush(ink);
    painter.drawEllipse(QRectF(kMargin, rect.center().y() - 4, 8, 8));
    painter.setPen(inks.faintText);
    const double room = names - metrics.horizontalAdvance(foot) - 8 - 2 * kSpacing;
    painter.drawText(whole.adjusted(8 + kSpacing, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter,
                     metrics.elidedText(row.motion, Qt::ElideRight, static_cast<int>(room)));
  }
  painter.fillRect(
      QRectF(axis.x(0), rect.top() + 3, axis.x(row.seconds) - axis.x(0), rect.height() - 6),
      inks.grid);
  painter.setPen(Qt::NoPen);
  painter.setBrush(shownColour(row.colour, isDark(palette())));
  for (const TimeRange& contact : row.contacts) {
    const double left = axis.x(contact.beginS);
    const double wide = std::max(1.0, axis.x(contact.endS) - left);
    painter.drawRoundedRect(QRectF(left, rect.top() + 3, wide, rect.height() - 6), 2, 2);
  }
}

void GaitView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  if (m_rows.empty()) {
    drawHint(painter, rect(), m_hint, inks.faintText);
    return;
  }
  painter.setRenderHint(QPainter::Antialiasing);
  const TimeAxis& axis = m_ruler.axis();
  const int step = rowHeight();
  for (size_t i = 0; i < m_rows.size(); ++i)
    paintRow(painter, inks, m_rows[i],
             QRectF(0, kSpacing + static_cast<double>(i) * step, width(), step));
  if (m_leftOut > 0) {
    painter.setPen(inks.faintText);
    painter.drawText(QPointF(axis.left, height() - kSpacing),
                     tr("%1 more selected motions are not shown").arg(m_leftOut));
  }
  if (const auto& range = m_workspace.view().range()) {
    QColor veil = inks.background;
    veil.setAlpha(170);
    const double begin = axis.x(std::clamp(range->beginS, 0.0, axis.seconds));
    const double end = axis.x(std::clamp(range->endS, 0.0, axis.seconds));
    painter.fillRect(QRectF(axis.left, 0, begin - axis.left, height()), veil);
    painter.fillRect(QRectF(end, 0, axis.right - end, height()), veil);
  }
  painter.setPen(QPen(inks.warning, 1.6));
  const double x = axis.x(m_workspace.view().time());
  painter.drawLine(QPointF(x, 0), QPointF(x, height()));
}

render::ChartGrid GaitView::chart() const {
  if (m_rows.empty()) return {};
  render::Chart chart{.title = tr("Foot contacts").toStdString(),
                      .x = {.label = tr("time").toStdString(), .unit = "s"},
                      .legend = render::LegendPlace::None};
  std::string motion;
  for (size_t i = 0; i < m_rows.size(); ++i) {
    const GaitRow& row = m_rows[i];
    if (row.first) motion = row.motion.toStdString();
    const std::string name = motion + ", " + row.foot.toStdString();
    chart.y.categories.push_back(name);
    render::Series bars{
        .kind = render::SeriesKind::Intervals, .name = name, .colour = row.colour, .width = 0.62};
    for (const TimeRange& contact : row.contacts) {
      bars.y.push_back(static_cast<double>(i) + 0.5);
      bars.low.push_back(contact.beginS);
      bars.high.push_back(contact.endS);
    }
    chart.series.push_back(std::move(bars));
  }
  return render::single(std::move(chart));
}

void GaitView::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && m_workspace.motions().duration() > 0.0)
    m_workspace.view().setTime(m_ruler.axis().at(event->localPos().x()));
}

void GaitView::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons().testFlag(Qt::LeftButton) && m_workspace.motions().duration() > 0.0)
    m_workspace.view().setTime(m_ruler.axis().at(event->localPos().x()));
}

bool GaitView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const int index = (help->pos().y() - kSpacing) / rowHeight();
  QString text;
  if (index >= 0 && index < static_cast<int>(m_rows.size())) {
    const GaitRow& row = m_rows[static_cast<size_t>(index)];
    text = QStringLiteral("%1, %2").arg(row.motion, row.foot);
    const double seconds = m_ruler.axis().at(help->pos().x());
    for (const TimeRange& contact : row.contacts)
      if (seconds >= contact.beginS && seconds <= contact.endS)
        text += tr("\nrests %1 s, from %2 s to %3 s")
                    .arg(contact.endS - contact.beginS, 0, 'f', 2)
                    .arg(contact.beginS, 0, 'f', 2)
                    .arg(contact.endS, 0, 'f', 2);
  }
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

}  // namespace marey::gui

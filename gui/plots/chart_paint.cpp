// What lies over the picture of a chart: cheap enough for every frame of a playback.
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "gui/plots/chart_view.h"
#include <fmt/format.h>

namespace marey::gui {
namespace {

QColor toColour(const render::Colour& c, double opacity = 1.0) {
  return QColor::fromRgbF(c.r, c.g, c.b, opacity);
}

QRectF plotOf(const render::ChartFrame& f) {
  return {f.left, f.top, f.right - f.left, f.bottom - f.top};
}

std::string valueText(double value, const render::Axis& axis) {
  if (!axis.categories.empty()) {
    const auto index = static_cast<size_t>(std::max(0.0, std::floor(value)));
    return index < axis.categories.size() ? axis.categories[index] : "";
  }
  return fmt::format("{} {:.4g}{}{}", axis.label, value, axis.unit.empty() ? "" : " ", axis.unit);
}

/// Pieces between neighbouring finite values. Qt strokes one long path that turns back and forth
/// hundreds of times slower than its pieces.
QVector<QLineF> piecesOf(const ChartHighlight& highlight, const render::ChartFrame& frame) {
  QVector<QLineF> out;
  std::optional<QPointF> last;
  for (size_t i = 0; i < highlight.x.size() && i < highlight.y.size(); ++i) {
    std::optional<QPointF> at;
    if (std::isfinite(highlight.y[i]))
      at = QPointF(frame.pixelX(highlight.x[i]), frame.pixelY(highlight.y[i]));
    if (at && last) out.push_back({*last, *at});
    last = at;
  }
  return out;
}
}  // namespace

void ChartView::paintEvent(QPaintEvent*) {
  draw();
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  if (m_picture.isNull()) return;
  painter.drawImage(0, 0, m_picture);
  painter.setRenderHint(QPainter::Antialiasing);
  paintRange(painter);
  drawHighlights();
  if (!m_lit.isNull()) painter.drawImage(0, 0, m_lit);
  paintCursor(painter);
  paintHover(painter);
}

void ChartView::paintRange(QPainter& painter) const {
  QColor shade = palette().color(QPalette::Highlight);
  shade.setAlphaF(0.16);
  const auto fill = [&](const render::ChartFrame& f, double left, double right) {
    const double a = std::max(f.left, left), b = std::min(f.right, right);
    if (b > a) painter.fillRect(QRectF(a, f.top, b - a, f.bottom - f.top), shade);
  };
  if (m_drag && m_drag->moved) {
    const auto [left, right] = std::minmax(m_drag->fromX, m_drag->toX);
    fill(m_frames[static_cast<size_t>(m_drag->chart) % m_frames.size()], left, right);
    return;
  }
  if (!m_range) return;
  for (const render::ChartFrame& f : m_frames)
    fill(f, f.pixelX(m_range->low), f.pixelX(m_range->high));
}

void ChartView::drawHighlights() const {
  if (!m_lit.isNull() || m_highlights.empty()) return;
  m_lit = QImage(m_picture.size(), QImage::Format_ARGB32_Premultiplied);
  m_lit.setDevicePixelRatio(m_picture.devicePixelRatio());
  m_lit.fill(Qt::transparent);
  QPainter painter(&m_lit);
  painter.setRenderHint(QPainter::Antialiasing);
  const auto pen = [](const QColor& colour, double width) {
    return QPen(colour, width, Qt::SolidLine, Qt::RoundCap);
  };
  for (const ChartHighlight& highlight : m_highlights) {
    if (highlight.chart < 0 || highlight.chart >= static_cast<int>(m_frames.size())) continue;
    const render::ChartFrame& frame = m_frames[static_cast<size_t>(highlight.chart)];
    const QVector<QLineF> pieces = piecesOf(highlight, frame);
    painter.setClipRect(plotOf(frame));
    // A rim in the colour of the page lifts the curve out of the others.
    painter.setPen(pen(toColour(m_shown.theme.background, 1.0), 5.0));
    painter.drawLines(pieces);
    painter.setPen(pen(toColour(render::themed(highlight.colour, m_shown.theme)), 2.4));
    painter.drawLines(pieces);
  }
}

void ChartView::paintCursor(QPainter& painter) const {
  if (!m_cursor) return;
  painter.setPen(QPen(palette().color(QPalette::Highlight), 1.6));
  for (const render::ChartFrame& f : m_frames) {
    const double x = f.pixelX(*m_cursor);
    if (x >= f.left - 0.5 && x <= f.right + 0.5)
      painter.drawLine(QPointF(x, f.top), QPointF(x, f.bottom));
  }
}

QString ChartView::hoverText(const ChartHit& hit) const {
  const render::Chart& chart = m_shown.charts[static_cast<size_t>(hit.chart)];
  std::string text = valueText(hit.x, chart.x);
  if (!hit.curve) return QString::fromStdString(text + "\n" + valueText(hit.y, chart.y));
  const render::Series& series = chart.series[static_cast<size_t>(hit.curve->series)];
  if (!series.name.empty()) text += "\n" + series.name;
  const QString motion = m_namer ? m_namer(*hit.curve) : QString();
  if (!motion.isEmpty())
    text += "\n" + motion.toStdString();
  else if (hit.curve->row >= 0)
    text += fmt::format(", motion {}", hit.curve->row + 1);
  // The height of a violin's row says only whose it is.
  if (chart.y.categories.empty()) text += "\n" + valueText(hit.curveY, chart.y);
  return QString::fromStdString(text);
}

QString ChartView::textAt(const QPoint& at) const {
  draw();
  const auto hit = hitAt(m_shown, m_frames, at.x(), at.y());
  return hit ? hoverText(*hit) : QString();
}

void ChartView::paintHover(QPainter& painter) const {
  if (!m_hover || m_drag) return;
  const auto hit = hitAt(m_shown, m_frames, m_hover->x(), m_hover->y());
  if (!hit) return;
  const render::ChartFrame& f = m_frames[static_cast<size_t>(hit->chart)];
  QColor faint = palette().color(QPalette::PlaceholderText);
  faint.setAlphaF(0.7);
  painter.setPen(QPen(faint, 1.0, Qt::DotLine));
  painter.drawLine(QPointF(m_hover->x(), f.top), QPointF(m_hover->x(), f.bottom));
  painter.drawLine(QPointF(f.left, m_hover->y()), QPointF(f.right, m_hover->y()));
  const QString text = hoverText(*hit);
  QRectF box = painter.fontMetrics()
                   .boundingRect(QRect(0, 0, 400, 200), Qt::AlignLeft | Qt::TextDontClip, text)
                   .adjusted(-7, -4, 7, 4);
  // Beside the pointer, on the side where there is room.
  const double x = m_hover->x() + 14 + box.width() > width() ? m_hover->x() - 14 - box.width()
                                                             : m_hover->x() + 14;
  const double y = std::clamp<double>(m_hover->y() - box.height() - 8, 2.0,
                                      std::max(2.0, height() - box.height() - 2.0));
  box.moveTopLeft({std::max(2.0, x), y});
  QColor plate = palette().color(QPalette::ToolTipBase);
  plate.setAlphaF(0.92);
  painter.setPen(QPen(palette().color(QPalette::Mid), 1.0));
  painter.setBrush(plate);
  painter.drawRoundedRect(box, 4, 4);
  painter.setPen(palette().color(QPalette::ToolTipText));
  painter.drawText(box.adjusted(7, 4, -7, -4), Qt::AlignLeft | Qt::TextDontClip, text);
}

}  // namespace marey::gui

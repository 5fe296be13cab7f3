#include "gui/scene/scene_overlay.h"

#include <QPaintEvent>
#include <algorithm>

#include "gui/scene/scene_legend.h"

namespace marey::gui {

SceneOverlay::SceneOverlay(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("sceneOverlay"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_NoSystemBackground);
  setFocusPolicy(Qt::NoFocus);
}

void SceneOverlay::setHint(const QString& hint) {
  if (hint == m_hint) return;
  m_hint = hint;
  update();
}

void SceneOverlay::setMode(const QString& text) {
  if (text == m_mode) return;
  m_mode = text;
  update();
}

void SceneOverlay::setHover(const QString& text, const QPoint& at) {
  if (text == m_hover && (text.isEmpty() || at == m_hoverAt)) return;
  m_hover = text;
  m_hoverAt = at;
  update();
}

void SceneOverlay::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setFont(readableFont(font()));
  const Inks inks = inksOf(palette());
  if (m_tool) {
    painter.save();
    m_tool(painter, inks);
    painter.restore();
  }
  if (!m_hint.isEmpty()) drawHint(painter, rect(), m_hint, inks.faintText);
  if (m_content) paintSceneLegend(painter, m_content->legend, size(), inks, isDark(palette()));
  if (!m_mode.isEmpty()) paintNote(painter, inks, m_mode, QPointF(kMargin, height() - kMargin));
  if (!m_hover.isEmpty()) {
    const double wide = painter.fontMetrics().horizontalAdvance(m_hover) + 2.0 * kSpacing;
    const double x = std::clamp(m_hoverAt.x() + 14.0, 0.0, std::max(0.0, width() - wide));
    paintNote(painter, inks, m_hover, QPointF(x, std::max(30.0, m_hoverAt.y() - 8.0)));
  }
}

void SceneOverlay::paintNote(QPainter& painter, const Inks& inks, const QString& text,
                             QPointF bottomLeft) const {
  const QFontMetrics metrics = painter.fontMetrics();
  const double room = width() - bottomLeft.x() - kMargin;
  const QRect wanted(0, 0, std::max(80, static_cast<int>(room) - 2 * kSpacing), 1000);
  QRectF box = metrics.boundingRect(wanted, Qt::TextWordWrap, text);
  box.adjust(-kSpacing, -3, kSpacing, 3);
  box.moveBottomLeft(bottomLeft);
  drawPlate(painter, box, inks.background);
  painter.setPen(inks.text);
  painter.drawText(box.adjusted(kSpacing, 3, -kSpacing + 2, -3), Qt::TextWordWrap, text);
}

}  // namespace marey::gui

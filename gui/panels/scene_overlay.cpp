#include "panels/scene_overlay.h"

#include <QPaintEvent>
#include <algorithm>

#include "render/ticks.h"

namespace marey::gui {
namespace {

constexpr int kMostLegendLines = 10;
constexpr int kSwatch = 11;

}  // namespace

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
  if (m_content) {
    paintLegend(painter, inks);
    paintScale(painter, inks);
  }
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

void SceneOverlay::paintLegend(QPainter& painter, const Inks& inks) const {
  if (m_content->legend.empty()) return;
  const QFontMetrics metrics = painter.fontMetrics();
  const bool swatches = std::any_of(m_content->motions.begin(), m_content->motions.end(),
                                    [](const auto& m) { return m.frameColours.empty(); });
  QStringList lines;
  const int count = static_cast<int>(m_content->legend.size());
  const int shown = count > kMostLegendLines ? kMostLegendLines - 1 : count;
  for (int i = 0; i < shown; ++i)
    lines << metrics.elidedText(m_content->legend[static_cast<size_t>(i)].text, Qt::ElideRight,
                                std::max(90, width() / 3));
  if (shown < count) lines << tr("and %1 more").arg(count - shown);
  if (!m_content->note.isEmpty()) lines << m_content->note;
  int wide = 0;
  for (const QString& line : lines) wide = std::max(wide, metrics.horizontalAdvance(line));
  const int step = metrics.height() + 3;
  const int indent = swatches ? kSwatch + kSpacing : 0;
  const QRectF box(kMargin, kMargin, wide + indent + 2 * kSpacing, step * lines.size() + kSpacing);
  drawPlate(painter, box, inks.background);
  painter.setRenderHint(QPainter::Antialiasing);
  for (int i = 0; i < lines.size(); ++i) {
    const double top = box.top() + kSpacing / 2.0 + i * step;
    const bool swatch = swatches && i < shown;
    if (swatch) {
      painter.setPen(Qt::NoPen);
      painter.setBrush(
          shownColour(m_content->legend[static_cast<size_t>(i)].colour, isDark(palette())));
      painter.drawEllipse(
          QRectF(box.left() + kSpacing, top + (step - kSwatch) / 2.0, kSwatch, kSwatch));
    }
    painter.setPen(i < shown ? inks.text : inks.faintText);
    painter.drawText(
        QRectF(box.left() + kSpacing + (i < shown ? indent : 0), top, box.width(), step),
        Qt::AlignVCenter | Qt::AlignLeft, lines[i]);
  }
}

void SceneOverlay::paintScale(QPainter& painter, const Inks& inks) const {
  if (!m_content->scale) return;
  const ScaleRange& range = *m_content->scale;
  const QFontMetrics metrics = painter.fontMetrics();
  const int wide = std::max(180, metrics.horizontalAdvance(m_content->scaleTitle)) + 2 * kMargin;
  const int line = metrics.height();
  // Along the lower edge, where the legend cannot reach.
  const QRectF box(width() - wide - kMargin, height() - (2 * line + 22) - kMargin, wide,
                   2 * line + 22);
  drawPlate(painter, box, inks.background);
  painter.setPen(inks.text);
  painter.drawText(box.adjusted(kMargin, 3, -kMargin, 0), Qt::AlignTop | Qt::AlignLeft,
                   m_content->scaleTitle);
  const QRectF bar(box.left() + kMargin + 8, box.top() + line + 5, box.width() - 2 * kMargin - 16,
                   10);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (int k = 0; k <= 16; ++k) gradient.setColorAt(k / 16.0, toQColor(scaleColour(k / 16.0)));
  painter.setPen(inks.faintText);
  painter.setBrush(gradient);
  painter.drawRect(bar);
  const render::Ticks ticks = render::niceTicks(range.low, range.high, 4);
  painter.setPen(inks.text);
  for (size_t i = 0; i < ticks.values.size(); ++i) {
    const double x = bar.left() + range.share(ticks.values[i]) * bar.width();
    painter.drawLine(QPointF(x, bar.bottom()), QPointF(x, bar.bottom() + 3));
    painter.drawText(QRectF(x - 40, bar.bottom() + 3, 80, line), Qt::AlignHCenter | Qt::AlignTop,
                     QString::fromStdString(ticks.labels[i]));
  }
}

}  // namespace marey::gui

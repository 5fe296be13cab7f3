#include "gui/scene/scene_legend.h"

#include <QCoreApplication>
#include <QGuiApplication>
#include <QImage>
#include <algorithm>

#include "render/chart/ticks.h"

namespace marey::gui {
namespace {

constexpr int kMostLegendLines = 10;
constexpr int kSwatch = 11;
/// The height of a picture at which its legend is as large as the window's, pixels.
constexpr double kUsualHeight = 720.0;

void paintGroups(QPainter& painter, const SceneLegend& legend, const QSize& area, const Inks& inks,
                 bool dark) {
  if (legend.groups.empty()) return;
  const QFontMetrics metrics = painter.fontMetrics();
  QStringList lines;
  const int count = static_cast<int>(legend.groups.size());
  const int shown = count > kMostLegendLines ? kMostLegendLines - 1 : count;
  for (int i = 0; i < shown; ++i)
    lines << metrics.elidedText(legend.groups[static_cast<size_t>(i)].text, Qt::ElideRight,
                                std::max(90, area.width() / 3));
  if (shown < count)
    lines << QCoreApplication::translate("Scene", "and %1 more").arg(count - shown);
  if (!legend.note.isEmpty()) lines << legend.note;
  int wide = 0;
  for (const QString& line : lines) wide = std::max(wide, metrics.horizontalAdvance(line));
  const int step = metrics.height() + 3;
  const int indent = legend.groupColours ? kSwatch + kSpacing : 0;
  const QRectF box(kMargin, kMargin, wide + indent + 2 * kSpacing, step * lines.size() + kSpacing);
  drawPlate(painter, box, inks.background);
  painter.setRenderHint(QPainter::Antialiasing);
  for (int i = 0; i < lines.size(); ++i) {
    const double top = box.top() + kSpacing / 2.0 + i * step;
    const bool swatch = legend.groupColours && i < shown;
    if (swatch) {
      painter.setPen(Qt::NoPen);
      painter.setBrush(shownColour(legend.groups[static_cast<size_t>(i)].colour, dark));
      painter.drawEllipse(
          QRectF(box.left() + kSpacing, top + (step - kSwatch) / 2.0, kSwatch, kSwatch));
    }
    painter.setPen(i < shown ? inks.text : inks.faintText);
    painter.drawText(
        QRectF(box.left() + kSpacing + (i < shown ? indent : 0), top, box.width(), step),
        Qt::AlignVCenter | Qt::AlignLeft, lines[i]);
  }
}

void paintScale(QPainter& painter, const SceneLegend& legend, const QSize& area, const Inks& inks) {
  if (!legend.scale) return;
  const ScaleRange& range = *legend.scale;
  const QFontMetrics metrics = painter.fontMetrics();
  const int wide = std::max(180, metrics.horizontalAdvance(legend.scaleTitle)) + 2 * kMargin;
  const int line = metrics.height();
  // Along the lower edge, where the legend cannot reach.
  const QRectF box(area.width() - wide - kMargin, area.height() - (2 * line + 22) - kMargin, wide,
                   2 * line + 22);
  drawPlate(painter, box, inks.background);
  painter.setPen(inks.text);
  painter.drawText(box.adjusted(kMargin, 3, -kMargin, 0), Qt::AlignTop | Qt::AlignLeft,
                   legend.scaleTitle);
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

}  // namespace

void paintSceneLegend(QPainter& painter, const SceneLegend& legend, const QSize& area,
                      const Inks& inks, bool dark) {
  paintGroups(painter, legend, area, inks, dark);
  paintScale(painter, legend, area, inks);
}

render::Image legendPicture(const SceneLegend& legend, int width, int height, bool dark) {
  QImage picture(width, height, QImage::Format_RGBA8888);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  const double scale = std::clamp(height / kUsualHeight, 0.6, 6.0);
  painter.scale(scale, scale);
  painter.setFont(readableFont(QGuiApplication::font()));
  paintSceneLegend(painter, legend, QSizeF(width / scale, height / scale).toSize(),
                   inksOf(paletteOf(dark ? Theme::Dark : Theme::Light)), dark);
  painter.end();
  render::Image out(width, height);
  for (int y = 0; y < height; ++y)
    std::copy_n(picture.constScanLine(y), 4 * static_cast<size_t>(width), out.at(0, y));
  return out;
}

}  // namespace marey::gui

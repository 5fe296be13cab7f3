#include "gui/common/paint_style.h"

#include <algorithm>

namespace marey::gui {

QColor toQColor(const render::Colour& colour) {
  return QColor::fromRgbF(colour.r, colour.g, colour.b, colour.a);
}

QColor shownColour(const render::Colour& colour, bool dark) {
  return toQColor(dark ? render::onDark(colour) : colour);
}

Inks inksOf(const QPalette& palette) {
  const bool dark = isDark(palette);
  const QColor text = palette.color(QPalette::WindowText);
  const auto ink = [&text](double opacity) {
    QColor out = text;
    out.setAlphaF(opacity);
    return out;
  };
  return {.background = palette.color(QPalette::Base),
          .text = text,
          .faintText = ink(0.65),
          .grid = ink(0.10),
          .strongGrid = ink(0.24),
          .accent = palette.color(QPalette::Highlight),
          .warning = dark ? QColor(0xff, 0x8c, 0x1a) : QColor(0xd9, 0x5f, 0x02),
          .mildWarning = dark ? QColor(0xf2, 0xc1, 0x85) : QColor(0xf0, 0xa8, 0x5a),
          .error = dark ? QColor(0xff, 0x8a, 0x80) : QColor(0xb0, 0x1e, 0x1e)};
}

QFont readableFont(QFont font) {
  if (font.pointSizeF() > 0.0) font.setPointSizeF(std::max(10.0, font.pointSizeF()));
  return font;
}

void drawPlate(QPainter& painter, const QRectF& rect, const QColor& background) {
  QColor plate = background;
  plate.setAlpha(215);
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(plate);
  painter.drawRoundedRect(rect, 5, 5);
  painter.restore();
}

void drawHint(QPainter& painter, const QRect& rect, const QString& text, const QColor& ink) {
  painter.save();
  painter.setPen(ink);
  const int edge = std::max(kMargin, rect.width() / 12);
  painter.drawText(rect.adjusted(edge, kMargin, -edge, -kMargin),
                   Qt::AlignCenter | Qt::TextWordWrap, text);
  painter.restore();
}

}  // namespace marey::gui

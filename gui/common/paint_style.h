// What painted views have in common: inks that fit a light and a dark window, and round corners.
#pragma once

#include <QColor>
#include <QFont>
#include <QPainter>
#include <QPalette>
#include <QString>

#include "gui/common/theme.h"

#include "render/base/colours.h"

namespace marey::gui {

/// Space between things that belong together, and around them, pixels.
inline constexpr int kSpacing = 6;
inline constexpr int kMargin = 8;

QColor toQColor(const render::Colour& colour);
/// As drawn: natural motion, near-black, is lifted on a dark background.
QColor shownColour(const render::Colour& colour, bool dark);

/// Inks of a painted view.
struct Inks {
  QColor background, text, faintText, grid, strongGrid, accent;
  QColor warning;      ///< leaves what was ever seen in natural motion
  QColor mildWarning;  ///< rare in natural motion
  QColor error;
};
Inks inksOf(const QPalette& palette);

/// The font for marks in views: that of the widget, and 10 pt at least.
QFont readableFont(QFont font);
/// A round-cornered plate behind text over a picture.
void drawPlate(QPainter& painter, const QRectF& rect, const QColor& background);
/// One helpful sentence in the middle of an empty view.
void drawHint(QPainter& painter, const QRect& rect, const QString& text, const QColor& ink);

}  // namespace marey::gui

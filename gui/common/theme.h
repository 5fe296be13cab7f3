// Light and dark: palette, style sheet and icons drawn in the palette's ink.
#pragma once

#include <QApplication>
#include <QIcon>
#include <QPalette>

namespace marey::gui {

enum class Theme { Light, Dark };

QPalette paletteOf(Theme theme);
void applyTheme(QApplication& application, Theme theme);
/// Whether a palette is a dark one: what pictures choose their background by.
bool isDark(const QPalette& palette);

}  // namespace marey::gui

#include "gui/common/theme.h"

#include <QFontDatabase>
#include <QStyleFactory>

namespace marey::gui {
namespace {

struct Inks {
  QColor window, base, alternate, button, text, faint, line, accent, accentText;
};

Inks inksOf(Theme theme) {
  if (theme == Theme::Dark)
    return {"#23262b", "#1b1d21", "#202328", "#2e3238", "#e6e8eb",
            "#949ba5", "#3b4048", "#4fa3d9", "#0b0d0f"};
  return {"#f3f4f6", "#ffffff", "#f7f8fa", "#e9ebef", "#1d2126",
          "#69717c", "#cfd4db", "#0072b2", "#ffffff"};
}

QPalette paletteOf(const Inks& k) {
  QPalette p;
  p.setColor(QPalette::Window, k.window);
  p.setColor(QPalette::WindowText, k.text);
  p.setColor(QPalette::Base, k.base);
  p.setColor(QPalette::AlternateBase, k.alternate);
  p.setColor(QPalette::ToolTipBase, k.base);
  p.setColor(QPalette::ToolTipText, k.text);
  p.setColor(QPalette::Text, k.text);
  p.setColor(QPalette::Button, k.button);
  p.setColor(QPalette::ButtonText, k.text);
  p.setColor(QPalette::BrightText, Qt::white);
  p.setColor(QPalette::Link, k.accent);
  p.setColor(QPalette::Highlight, k.accent);
  p.setColor(QPalette::HighlightedText, k.accentText);
  p.setColor(QPalette::PlaceholderText, k.faint);
  p.setColor(QPalette::Light, k.base);
  p.setColor(QPalette::Midlight, k.line);
  p.setColor(QPalette::Mid, k.line);
  p.setColor(QPalette::Dark, k.line);
  p.setColor(QPalette::Shadow, k.line);
  for (const auto role : {QPalette::Text, QPalette::WindowText, QPalette::ButtonText})
    p.setColor(QPalette::Disabled, role, k.faint);
  return p;
}

QString sheetOf(const Inks& k) {
  return QStringLiteral(
             "QToolTip { color: %1; background: %2; border: 1px solid %3; padding: 4px; }"
             "QMenuBar { background: %4; } QMenuBar::item { padding: 4px 9px; }"
             "QMenu { background: %2; border: 1px solid %3; padding: 4px; }"
             "QMenu::item { padding: 5px 26px 5px 22px; border-radius: 3px; }"
             "QMenu::item:selected { background: %5; color: %6; }"
             "QMenu::separator { height: 1px; background: %3; margin: 4px 8px; }"
             "QHeaderView::section { background: %4; border: 0; border-bottom: 1px solid %3;"
             " padding: 4px 6px; }"
             "QTreeView, QTableView, QListView { border: 1px solid %3; }"
             "QToolBar { border: 0; spacing: 3px; } QStatusBar::item { border: 0; }"
             "QProgressBar { border: 1px solid %3; border-radius: 3px; text-align: center;"
             " background: %2; } QProgressBar::chunk { background: %5; }"
             "QCheckBox::indicator:unchecked { border: 1px solid %7; border-radius: 2px;"
             " background: %2; width: 12px; height: 12px; }"
             "ads--CDockContainerWidget, ads--CDockSplitter { background: %4; }"
             "ads--CDockAreaWidget { background: %4; border: 1px solid %3; }"
             "ads--CDockAreaTitleBar { background: %4; border-bottom: 1px solid %3; padding: 0; }"
             "ads--CDockWidgetTab { background: %4; border: 0; padding: 3px 8px; }"
             "ads--CDockWidgetTab[activeTab=\"true\"] { background: %2;"
             " border-bottom: 2px solid %5; }"
             "ads--CDockWidgetTab QLabel { color: %7; }"
             "ads--CDockWidgetTab[activeTab=\"true\"] QLabel { color: %1; }"
             "ads--CDockWidget { background: %4; border: 0; }")
      .arg(k.text.name(), k.base.name(), k.line.name(), k.window.name(), k.accent.name(),
           k.accentText.name(), k.faint.name());
}

}  // namespace

QPalette paletteOf(Theme theme) {
  return paletteOf(inksOf(theme));
}

void applyTheme(QApplication& application, Theme theme) {
  const Inks inks = inksOf(theme);
  application.setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  application.setPalette(paletteOf(theme));
  application.setStyleSheet(sheetOf(inks));
}

bool isDark(const QPalette& palette) {
  return palette.color(QPalette::Window).lightnessF() < 0.5;
}

}  // namespace marey::gui

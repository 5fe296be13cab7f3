// The commands of the menus: each with a name, keys and what it does.
#pragma once

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <functional>
#include <vector>

namespace marey::gui {

class Menus {
 public:
  explicit Menus(QMainWindow& window) : m_window(window) {}

  QMenu* addMenu(const QString& title);
  QAction* add(QMenu* menu, const QString& name, const QString& text, const QKeySequence& keys,
               const std::function<void()>& run);
  /// A command of something the window does not know, at the end of the menu of that title (of
  /// File: before Quit), which is made where there is none.
  void addCommand(const QString& menu, const QString& name, const QString& text,
                  const QKeySequence& keys, const std::function<void()>& run);
  const std::vector<QAction*>& commands() const { return m_commands; }
  QAction* command(const QString& name) const;  ///< by objectName; null without one

 private:
  QMainWindow& m_window;
  std::vector<QAction*> m_commands;
};

}  // namespace marey::gui

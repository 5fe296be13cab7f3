#include "gui/shell/menus.h"

#include <QMenuBar>
#include <algorithm>

#include "gui/common/number_box.h"

namespace marey::gui {

QMenu* Menus::addMenu(const QString& title) {
  return m_window.menuBar()->addMenu(title);
}

QAction* Menus::add(QMenu* menu, const QString& name, const QString& text, const QKeySequence& keys,
                    const std::function<void()>& run) {
  auto* action = new QAction(text, &m_window);
  action->setObjectName(name);
  action->setShortcut(keys);
  action->setProperty("menu", menu->title().remove(QLatin1Char('&')));
  QObject::connect(action, &QAction::triggered, &m_window, [run] {
    finishTyping();
    run();
  });
  menu->addAction(action);
  m_commands.push_back(action);
  return action;
}

QAction* Menus::command(const QString& name) const {
  const auto found = std::find_if(m_commands.begin(), m_commands.end(), [&](const QAction* action) {
    return action->objectName() == name;
  });
  return found == m_commands.end() ? nullptr : *found;
}

void Menus::addCommand(const QString& title, const QString& name, const QString& text,
                       const QKeySequence& keys, const std::function<void()>& run) {
  QMenu* menu = nullptr;
  for (const QAction* entry : m_window.menuBar()->actions())
    if (entry->menu() != nullptr && entry->text().remove(u'&') == title) menu = entry->menu();
  if (menu == nullptr) menu = addMenu(title);
  QAction* added = add(menu, name, text, keys, run);
  QAction* quit = command(QStringLiteral("quit"));
  const auto entries = menu->actions();
  const auto at = entries.indexOf(quit);
  if (at < 1) return;
  // Before the line above Quit.
  menu->removeAction(added);
  menu->insertAction(entries[at - 1], added);
}

}  // namespace marey::gui

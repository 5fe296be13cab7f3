// The sheet of all keys.
#pragma once

#include <QAction>
#include <QStringList>
#include <QWidget>
#include <vector>

namespace marey::gui {

/// Shows the commands that have keys, then `lines` of keys that panels handle themselves
/// ("keys\twhat").
void showKeySheet(const std::vector<QAction*>& commands, const QStringList& lines, QWidget* parent);

}  // namespace marey::gui

// Questions for files.
#pragma once

#include <QString>

class QWidget;

namespace marey::gui {

/// Where to save; empty: not at all. The dialog adds `suffix` (without dot) itself, so that it also
/// asks about a file that is there under the whole name.
QString askSaveFile(QWidget* parent, const QString& title, const QString& start,
                    const QString& filter, const QString& suffix);

}  // namespace marey::gui

// Menu commands of dialogs that belong to no panel.
#pragma once

#include "gui/shell/main_window.h"

namespace marey::gui {

void addPanelCommands(MainWindow& window, Workspace& workspace);

}  // namespace marey::gui

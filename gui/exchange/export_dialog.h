// Asks how to export motions, runs the export and shows what came of it.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

/// The selected motions, or all visible ones. Not modal; deleted when closed.
void showExportDialog(Workspace& workspace, QWidget* parent);
/// Asks for a file and writes what the 3D view of the window shows, with its recipe.
void saveScenePicture(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

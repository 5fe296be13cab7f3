// Looks at motion files before they are added to the document: what they are, what is wrong with
// them, how they move, and what their reader should be told.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

/// Not modal; deleted when closed. Folders and lists are taken apart into their files.
void showImportDialog(Workspace& workspace, const QStringList& files, QWidget* parent);

}  // namespace marey::gui

// Natural clips and sample sets as a tree: colour, visibility, count, likelihood.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeLibraryPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

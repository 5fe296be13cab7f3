// The path that motions are asked to follow, drawn from above, with how natural its pace is.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makePathPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

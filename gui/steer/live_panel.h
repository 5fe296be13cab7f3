// Steering a model with the arrow keys while it moves.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeLivePanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

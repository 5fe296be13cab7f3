// Overlaid motions in 3D.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeScenePanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

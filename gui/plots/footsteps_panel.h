// Footsteps against speed tolerance, with v95 and step durations.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

QWidget* makeFootstepsPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

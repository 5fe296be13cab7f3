// Every edit of the document in order; click one to go there.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeHistoryPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

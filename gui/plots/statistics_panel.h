// The registry of statistics as a table, worked out on request.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

QWidget* makeStatisticsPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

// Quantities of joints over sets, and where on the body they differ from natural motion.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

QWidget* makeDistributionsPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

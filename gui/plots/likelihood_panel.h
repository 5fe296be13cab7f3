// Log-likelihood over time, of samples under their own model and of natural motion.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

QWidget* makeLikelihoodPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

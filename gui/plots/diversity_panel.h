// How far the motions of a set are from each other over time.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

QWidget* makeDiversityPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

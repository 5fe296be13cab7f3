// What is sampled: models with their temperature, number of samples, seed, path and length.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeSamplingPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

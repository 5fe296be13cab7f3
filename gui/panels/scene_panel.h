// Overlaid motions in 3D.
#pragma once

#include <QImage>

#include "shell/workspace.h"

namespace marey::gui {

QWidget* makeScenePanel(Workspace& workspace, QWidget* parent);
/// The scene of a panel made here, as shown with its legend; null for any other widget.
QImage grabScene(QWidget& panel);

}  // namespace marey::gui

// Overlaid motions in 3D.
#pragma once

#include <memory>

#include "gui/scene/shown_scene.h"
#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeScenePanel(Workspace& workspace, std::shared_ptr<ShownScene> shown, QWidget* parent);

}  // namespace marey::gui

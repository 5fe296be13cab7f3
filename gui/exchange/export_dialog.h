// Asks how to export motions, runs the export and shows what came of it.
#pragma once

#include <memory>

#include "gui/scene/shown_scene.h"
#include "gui/workspace/workspace.h"

namespace marey::gui {

/// The selected motions, or all visible ones. Not modal; deleted when closed.
void showExportDialog(Workspace& workspace, std::shared_ptr<const ShownScene> scene,
                      QWidget* parent);
/// Asks for a file and writes what the 3D view of the window shows, with its recipe.
void saveScenePicture(Workspace& workspace, const ShownScene& scene, QWidget* parent);

}  // namespace marey::gui

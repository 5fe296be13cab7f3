#include "gui/scene/scene_panel.h"

#include <QVBoxLayout>
#include <utility>

#include "gui/scene/scene_bar.h"
#include "gui/scene/scene_view.h"

namespace marey::gui {

QWidget* makeScenePanel(Workspace& workspace, std::shared_ptr<ShownScene> shown, QWidget* parent) {
  auto* panel = new QWidget(parent);
  panel->setObjectName(QStringLiteral("scenePanel"));
  auto* layout = new QVBoxLayout(panel);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  auto* view = new SceneView(workspace, std::move(shown), panel);
  layout->addWidget(new SceneBar(*view, panel, panel));
  layout->addWidget(view, 1);
  panel->setFocusProxy(view);
  return panel;
}

}  // namespace marey::gui

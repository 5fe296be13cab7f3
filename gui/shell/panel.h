// The list of panels: what the window docks, tests open, and the View menu names.
#pragma once

#include <QWidget>
#include <functional>
#include <memory>
#include <vector>

#include "gui/scene/shown_scene.h"
#include "gui/workspace/workspace.h"

namespace marey::gui {

/// Plots lie below what is at the right.
enum class PanelArea { Left, Centre, Right, Plots, Bottom };

/// What panels are made with; each takes what it needs.
struct Desk {
  Workspace& workspace;
  std::shared_ptr<ShownScene> scene;  ///< which the scene panel keeps as it is seen
};

/// One entry of the explicit list in shell/panels.cpp.
struct PanelSpec {
  QString id;     ///< stable: layouts are stored by it
  QString title;  ///< as shown
  PanelArea area = PanelArea::Right;
  std::function<QWidget*(const Desk&, QWidget* parent)> make;
};

}  // namespace marey::gui

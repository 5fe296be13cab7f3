// The list of panels: what the window docks, tests open, and the View menu names.
#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "gui/workspace/workspace.h"

namespace marey::gui {

/// Plots lie below what is at the right.
enum class PanelArea { Left, Centre, Right, Plots, Bottom };

/// One entry of the explicit list in shell/panels.cpp.
struct PanelSpec {
  QString id;     ///< stable: layouts are stored by it
  QString title;  ///< as shown
  PanelArea area = PanelArea::Right;
  std::function<QWidget*(Workspace&, QWidget* parent)> make;
};

}  // namespace marey::gui

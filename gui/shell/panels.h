// The explicit list of panels, in the order of their tabs.
#pragma once

#include <vector>

#include "gui/shell/panel.h"

namespace marey::gui {

const std::vector<PanelSpec>& panels();

}  // namespace marey::gui

// Plots of the workspace as files, with the recipe of what is shown.
#pragma once

#include "gui/plots/chart_out.h"
#include "gui/workspace/workspace.h"

namespace marey::gui {

/// `name` is that of the plot in recipes and the proposed name of its files.
ChartOut chartOutOf(Workspace& workspace, const QString& name,
                    std::function<render::ChartGrid()> grid);

}  // namespace marey::gui

#include "gui/plots/workspace_chart.h"

#include "gui/plots/plot_recipe.h"

namespace marey::gui {

ChartOut chartOutOf(Workspace& workspace, const QString& name,
                    std::function<render::ChartGrid()> grid) {
  return {.grid = std::move(grid),
          .recipe =
              [&workspace, name] {
                return plotRecipe(name.toStdString(), workspace.document().experiment(),
                                  workspace.motions().groups(), workspace.view().range());
              },
          .stem = name,
          .failed =
              [&workspace](const QString& error) {
                workspace.report(QObject::tr("The chart was not saved"), error);
              }};
}

}  // namespace marey::gui

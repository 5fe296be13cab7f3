#include "panels/footsteps_panel.h"

#include <QVBoxLayout>

#include "panels/plot_panel.h"
#include "panels/value_table.h"
#include "plots/footstep_data.h"

namespace marey::gui {
namespace {

class FootstepsPanel : public PlotPanel {
 public:
  FootstepsPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("footsteps"), false, parent) {
    m_table = new ValueTable(this);
    m_table->setObjectName(QStringLiteral("footstepsTable"));
    content()->addWidget(m_table, 1);
    chart()->setToolTip(
        tr("The dot is v95, the smallest tolerance that finds 95 % of the highest count: the "
           "further left, the more sharply the feet are planted."));
    connect(m_table, &QTableWidget::cellClicked, this, [this](int row, int) {
      const auto key = static_cast<size_t>(m_table->keyOf(row));
      if (key < m_rows.size()) selectMotions(m_rows[key].ids, false);
    });
  }

 protected:
  void refresh() override {
    const auto sets = motionSets(workspace().groups());
    if (sets.empty())
      return showHint(
          tr("No motion is visible: open natural clips or sample a path to count "
             "footsteps."));
    const std::vector<int> feet = workspace().feet();
    if (feet.empty())
      return showHint(
          tr("No feet were found in this skeleton: name them in the document's "
             "settings to count footsteps."));
    m_feet.clear();
    const auto skeleton = workspace().skeleton();
    for (const int foot : feet) m_feet.push_back(skeleton->names[static_cast<size_t>(foot)]);
    const stats::FootstepOptions options{.feet = feet,
                                         .stepCmS = workspace().experiment().toleranceStepCmS};
    const auto range = workspace().range();
    compute<std::vector<FootstepResult>>(
        tr("Counting footsteps"),
        [sets, range, options](Progress& progress) {
          return footstepResults(sets, range, options, progress);
        },
        [this](std::vector<FootstepResult>& results) { show(results); });
  }

  void rangeMoved() override { refreshSoon(); }

 private:
  void show(const std::vector<FootstepResult>& results) {
    if (results.empty()) return showHint(tr("No motion has frames inside the marked range."));
    showGrid(footstepGrid(results));
    m_rows = footstepRows(results, m_feet);
    std::vector<std::vector<ValueCell>> cells;
    for (const FootstepRow& row : m_rows) {
      ValueCell duration = numberCell(row.durationMeanS, 2);
      if (duration.value)
        duration.text += QStringLiteral(" ± ") + QString::number(row.durationStdS, 'f', 2);
      cells.push_back({{QString::fromStdString(row.set), {}, {}},
                       {QString::fromStdString(row.foot), {}, {}},
                       numberCell(row.steps, 0),
                       numberCell(row.stepsPerMinute, 1),
                       numberCell(row.v95CmS, 1),
                       duration});
    }
    m_table->setRows({tr("motions"), tr("foot"), tr("steps"), tr("steps per minute"),
                      tr("v95 [cm/s]"), tr("duration ± std [s]")},
                     cells);
  }

  ValueTable* m_table = nullptr;
  std::vector<std::string> m_feet;
  std::vector<FootstepRow> m_rows;
};
}  // namespace

QWidget* makeFootstepsPanel(Workspace& workspace, QWidget* parent) {
  return new FootstepsPanel(workspace, parent);
}

}  // namespace marey::gui

#include "gui/plots/footsteps_panel.h"

#include <QVBoxLayout>

#include "gui/common/value_table.h"
#include "gui/plots/comparison_choice.h"
#include "gui/plots/footstep_data.h"
#include "gui/plots/plot_panel.h"

namespace marey::gui {
namespace {

class FootstepsPanel : public PlotPanel {
 public:
  FootstepsPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("footsteps"), false, parent) {
    tools()->addWidget(new ComparisonChoice(workspace, QStringLiteral("footsteps"), this), 1);
    followComparison();
    m_table = new ValueTable(this);
    m_table->setObjectName(QStringLiteral("footstepsTable"));
    content()->addWidget(m_table, 1);
    chart()->setToolTip(tr(
        "The dot is v95, the smallest tolerance that finds 95 % of the highest count: the "
        "further left, the more sharply the feet are planted. A picked motion counts as if all of "
        "its set moved like it."));
    connect(m_table, &QTableWidget::cellClicked, this, [this](int row, int) {
      const auto key = static_cast<size_t>(m_table->keyOf(row));
      if (key < m_rows.size()) selectMotions(m_rows[key].ids, false);
    });
  }

 protected:
  void refresh() override {
    m_sets = motionSets(workspace().motions().groups(), comparison());
    const auto& sets = m_sets;
    showCounted(sets, ComparisonChoice::notes(workspace()));
    if (nothingHeldOut(sets)) return showHint(ComparisonChoice::missingText(workspace()));
    if (sets.empty())
      return showHint(
          tr("No motion is used: open natural clips or sample a path to count "
             "footsteps."));
    const Experiment& e = workspace().document().experiment();
    const FootstepQuery query{.feet = e.feet, .stepCmS = e.toleranceStepCmS};
    const auto range = workspace().view().range();
    using Counted = std::pair<std::vector<FootstepResult>, std::vector<std::string>>;
    compute<Counted>(
        tr("Counting footsteps"),
        [sets, range, query](Progress& progress) {
          Counted out;
          out.first = footstepResults(sets, range, query, progress, &out.second);
          return out;
        },
        [this](Counted& counted) {
          m_results = std::move(counted.first);
          showCounted(m_sets, ComparisonChoice::notes(workspace(), counted.second));
          show();
        });
  }

  void rangeMoved() override { refreshSoon(); }

  std::vector<ChartHighlight> curvesOf(const std::set<MotionId>& picked) const override {
    return footstepHighlights(m_results, picked);
  }

 private:
  void show() {
    if (m_results.empty())
      return showHint(tr("No motion with feet has frames inside the marked range."));
    showGrid(footstepGrid(m_results));
    m_rows = footstepRows(m_results);
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
  std::vector<MotionSet> m_sets;
  std::vector<FootstepResult> m_results;
  std::vector<FootstepRow> m_rows;
};
}  // namespace

QWidget* makeFootstepsPanel(Workspace& workspace, QWidget* parent) {
  return new FootstepsPanel(workspace, parent);
}

}  // namespace marey::gui

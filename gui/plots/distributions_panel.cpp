#include "gui/plots/distributions_panel.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <map>

#include "gui/common/value_table.h"
#include "gui/plots/body_map.h"
#include "gui/plots/comparison_choice.h"
#include "gui/plots/distribution_data.h"
#include "gui/plots/plot_panel.h"
#include "gui/plots/workspace_chart.h"

namespace marey::gui {
namespace {

class DistributionsPanel : public PlotPanel {
 public:
  DistributionsPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("distributions"), false, parent) {
    m_quantity = combo(QStringLiteral("distributionsQuantity"));
    for (const stats::Quantity quantity : stats::allQuantities())
      m_quantity->addItem(QString::fromStdString(stats::textOf(quantity).name));
    m_view = combo(QStringLiteral("distributionsView"));
    m_view->addItems({tr("Density"), tr("Violin"), tr("Over time"), tr("Table")});
    tools()->addWidget(new ComparisonChoice(workspace, QStringLiteral("distributions"), this), 1);
    followComparison();
    tools()->addWidget(new QLabel(tr("Body map:"), this));
    m_mapSet = combo(QStringLiteral("distributionsMapSet"));
    m_mapSet->setToolTip(tr("Whose distance to natural motion the body map shows"));
    layOut();
    connect(m_quantity, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            [this] { refreshSoon(); });
    connect(m_view, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            [this] { redraw(); });
    connect(m_mapSet, QOverload<int>::of(&QComboBox::activated), this, [this] { showMap(); });
    connect(m_joints, &QListWidget::itemSelectionChanged, this, [this] { jointsPicked(); });
    connect(m_map, &BodyMap::jointClicked, this, [this](int joint) {
      Selection next = this->workspace().view().selection();
      next.joint = joint;
      this->workspace().view().select(std::move(next));
    });
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
          tr("No motion is used: open natural clips or sample a path to see how "
             "its joints move."));
    fillJoints(sets.front().clips.front()->skeleton);
    DistributionQuery query{
        .quantity = quantity(), .joints = chosenJoints(), .range = workspace().view().range()};
    using Collected = std::pair<std::shared_ptr<const DistributionResult>, LinkedGrid>;
    compute<Collected>(
        tr("Collecting joint samples"),
        [sets, query, view = view()](Progress& progress) {
          auto result =
              std::make_shared<const DistributionResult>(distributionResult(sets, query, progress));
          LinkedGrid grid = distributionGrid(*result, view);
          return Collected{std::move(result), std::move(grid)};
        },
        [this, view = view()](Collected& collected) {
          m_result = std::move(collected.first);
          m_grids.clear();
          m_grids[view] = std::move(collected.second);
          show();
        });
  }

  std::vector<ChartHighlight> curvesOf(const std::set<MotionId>& picked) const override {
    return m_result ? distributionHighlights(*m_result, m_shownView, chart()->grid(), picked)
                    : std::vector<ChartHighlight>{};
  }

  void rangeMoved() override { refreshSoon(); }

  void selectionMoved() override {
    const auto joint = workspace().view().selection().joint;
    m_map->setJoint(joint);
    if (joint && *joint < m_joints->count() && !m_joints->item(*joint)->isSelected()) {
      m_following = true;
      m_joints->clearSelection();
      m_joints->item(*joint)->setSelected(true);
      m_joints->scrollToItem(m_joints->item(*joint));
      m_following = false;
      refreshSoon();
    }
    showHighlights();
  }

 private:
  QComboBox* combo(const QString& name) {
    auto* made = new QComboBox(this);
    made->setObjectName(name);
    made->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    tools()->addWidget(made);
    return made;
  }

  void layOut() {
    m_joints = new QListWidget(this);
    m_joints->setObjectName(QStringLiteral("distributionsJoints"));
    m_joints->setSelectionMode(QAbstractItemView::ExtendedSelection);
    m_joints->setToolTip(tr("Joints to plot; several with Ctrl or Shift"));
    m_map = new BodyMap(this);
    m_map->setObjectName(QStringLiteral("distributionsBodyMap"));
    new ChartMenu(m_map, chartOutOf(workspace(), QStringLiteral("body-map"),
                                    [this] { return m_map->chart(); }));
    m_table = new ValueTable(this);
    m_table->setObjectName(QStringLiteral("distributionsTable"));
    m_table->setToolTip(tr("W1: 1-Wasserstein distance to natural motion"));
    auto* row = new QHBoxLayout;
    content()->removeWidget(chartArea());
    // The charts need the rest, two beside each other.
    m_joints->setMaximumWidth(88);
    m_map->setMaximumWidth(140);
    row->addWidget(m_joints);
    row->addWidget(chartArea(), 1);
    row->addWidget(m_table, 1);
    row->addWidget(m_map);
    content()->addLayout(row, 1);
    m_table->hide();
  }

  stats::Quantity quantity() const {
    return stats::allQuantities()[static_cast<size_t>(std::max(0, m_quantity->currentIndex()))];
  }

  void fillJoints(const std::shared_ptr<const Skeleton>& skeleton) {
    QStringList names;
    for (const std::string& name : skeleton->names) names << QString::fromStdString(name);
    if (names == m_names) return;
    m_names = names;
    m_following = true;
    m_joints->clear();
    m_joints->addItems(names);
    const auto feet = workspace().feet();
    const int first =
        workspace().view().selection().joint.value_or(feet.empty() ? 0 : feet.front());
    if (first < m_joints->count()) m_joints->item(first)->setSelected(true);
    m_following = false;
  }

  std::vector<int> chosenJoints() const {
    std::vector<int> joints;
    for (int i = 0; i < m_joints->count(); ++i)
      if (m_joints->item(i)->isSelected()) joints.push_back(i);
    return joints;
  }

  void jointsPicked() {
    if (m_following) return;
    const std::vector<int> joints = chosenJoints();
    if (joints.size() == 1) {
      Selection next = workspace().view().selection();
      next.joint = joints.front();
      workspace().view().select(std::move(next));
    }
    refreshSoon();
  }

  void show() {
    if (m_result->sets.empty())
      return showHint(tr("No motion has frames inside the marked range."));
    const QString before = m_mapSet->currentText();
    m_mapSet->clear();
    for (const DistributionSet& set : m_result->sets)
      if (!set.look.natural) m_mapSet->addItem(QString::fromStdString(set.look.name));
    m_mapSet->setCurrentIndex(std::max(0, m_mapSet->findText(before)));
    showCounted(m_sets, ComparisonChoice::notes(workspace(), m_result->leftOut));
    redraw();
    showMap();
    fillTable();
  }

  /// The table has a view of its own: under four charts it would leave them no height.
  bool asTable() const { return m_view->currentIndex() == kTable; }
  DistributionView view() const {
    return asTable() ? m_shownView : static_cast<DistributionView>(m_view->currentIndex());
  }

  /// Densities of many samples take a while: those of a view are worked out beside the event loop.
  void redraw() {
    chartArea()->setVisible(!asTable());
    m_table->setVisible(asTable());
    if (!m_result) return;
    if (const auto known = m_grids.find(view()); known != m_grids.end()) {
      m_shownView = view();
      followTime(m_shownView == DistributionView::Envelope);
      return showGrid(known->second);
    }
    // What is being collected comes as this view then.
    if (computing()) return refreshSoon();
    compute<LinkedGrid>(
        tr("Drawing distributions"),
        [result = m_result, view = view()](Progress&) { return distributionGrid(*result, view); },
        [this, result = m_result, view = view()](LinkedGrid& grid) {
          if (result != m_result) return;
          m_grids[view] = std::move(grid);
          redraw();
        });
  }

  void showMap() {
    const stats::QuantityText& text = stats::textOf(m_result->query.quantity);
    BodyMapData data{
        .skeleton = m_result->skeleton, .pose = m_result->meanPose, .values = {}, .label = {}};
    for (const DistributionSet& set : m_result->sets)
      if (!set.look.natural && QString::fromStdString(set.look.name) == m_mapSet->currentText())
        data.values = set.distance;
    data.label = data.values.empty() ? tr("Click picks a joint")
                                     : tr("W1 of %1 [%2]")
                                           .arg(QString::fromStdString(text.name),
                                                QString::fromStdString(text.unit));
    m_map->setToolTip(tr("1-Wasserstein distance to natural motion at each joint"));
    m_map->setData(std::move(data));
    m_map->setJoint(workspace().view().selection().joint);
  }

  void fillTable() {
    const QString unit = QString::fromStdString(stats::textOf(m_result->query.quantity).unit);
    m_rows = distributionRows(*m_result);
    std::vector<std::vector<ValueCell>> cells;
    for (const DistributionRow& row : m_rows)
      cells.push_back({{QString::fromStdString(row.joint), {}, {}},
                       {QString::fromStdString(row.set), {}, {}},
                       numberCell(row.mean, 2),
                       numberCell(row.deviation, 2),
                       numberCell(row.distance, 2)});
    m_table->setRows({tr("joint"), tr("motions"), tr("mean [%1]").arg(unit),
                      tr("std [%1]").arg(unit), tr("W1 to natural [%1]").arg(unit)},
                     cells);
  }

  static constexpr int kTable = 3;  ///< in the list of views, after those of charts
  QComboBox *m_quantity = nullptr, *m_view = nullptr, *m_mapSet = nullptr;
  QListWidget* m_joints = nullptr;
  BodyMap* m_map = nullptr;
  ValueTable* m_table = nullptr;
  QStringList m_names;
  std::shared_ptr<const DistributionResult> m_result;
  std::map<DistributionView, LinkedGrid> m_grids;  ///< of the result
  DistributionView m_shownView = DistributionView::Density;
  std::vector<MotionSet> m_sets;
  std::vector<DistributionRow> m_rows;
  bool m_following = false;  ///< the list is being set, not used
};
}  // namespace

QWidget* makeDistributionsPanel(Workspace& workspace, QWidget* parent) {
  return new DistributionsPanel(workspace, parent);
}

}  // namespace marey::gui

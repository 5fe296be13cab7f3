#include "gui/plots/statistics_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <cmath>
#include <set>

#include "gui/common/file_dialogs.h"
#include "gui/common/value_table.h"
#include "gui/plots/comparison_choice.h"
#include "gui/plots/plot_panel.h"
#include "gui/plots/statistics_data.h"

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey::gui {
namespace {

QString numberText(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? QString::number(*value, 'g', 4) : QStringLiteral("–");
}

ValueCell valueCell(const std::optional<double>& value, const QString& toolTip) {
  const bool finite = value && std::isfinite(*value);
  return {numberText(value), finite ? value : std::nullopt, toolTip};
}

ValueCell intervalCell(const std::optional<double>& low, const std::optional<double>& high) {
  if (!low || !high) return {QStringLiteral("–"), std::nullopt, {}};
  return {QObject::tr("%1 to %2").arg(numberText(low), numberText(high)), *low, {}};
}

class StatisticsPanel : public PlotPanel {
 public:
  StatisticsPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("statistics"), false, parent) {
    chartArea()->hide();
    m_compute = button(QStringLiteral("statisticsCompute"), tr("Compute"));
    m_copy = button(QStringLiteral("statisticsCopy"), tr("Copy"));
    m_copy->setToolTip(tr("Copies the table as tab-separated text"));
    m_export = button(QStringLiteral("statisticsExport"), tr("Export CSV..."));
    tools()->insertWidget(0, new ComparisonChoice(workspace, QStringLiteral("statistics"), this),
                          1);
    followComparison();
    m_input = new QLabel(this);
    m_input->setObjectName(QStringLiteral("statisticsInput"));
    m_input->setWordWrap(true);
    m_table = new ValueTable(this);
    m_table->setObjectName(QStringLiteral("statisticsTable"));
    content()->addWidget(m_input);
    content()->addWidget(m_table, 1);
    connect(m_compute, &QPushButton::clicked, this, [this] { start(); });
    connect(m_copy, &QPushButton::clicked, this, [this] {
      QApplication::clipboard()->setText(QString::fromStdString(statisticsText(*m_shown, '\t')));
    });
    connect(m_export, &QPushButton::clicked, this, [this] { exportCsv(); });
    connect(&workspace.document(), &Document::changed, this, [this] { refreshSoon(); });
    m_copy->setEnabled(false);
    m_export->setEnabled(false);
  }

 protected:
  void refresh() override {
    const StatisticsInput input = inputNow();
    showCounted(input.sets, m_shown ? m_shown->notes : std::vector<std::string>{});
    const bool missing = nothingHeldOut(input.sets);
    m_compute->setEnabled(!input.sets.empty() && !missing);
    if (m_shown) return showInput(input);
    // A hint would end the work; what has changed meanwhile is told when it is done.
    if (computing()) return;
    if (missing) return showHint(ComparisonChoice::missingText(workspace()));
    showHint(input.sets.empty()
                 ? tr("No motion is used: open natural clips or sample a path first.")
                 : tr("Press \"Compute\" to work out every statistic of %1.")
                       .arg(QString::fromStdString(input.text())));
  }

  void rangeMoved() override { refreshSoon(); }
  void selectionMoved() override {}

 private:
  QPushButton* button(const QString& name, const QString& text) {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    tools()->addWidget(made);
    return made;
  }

  StatisticsInput inputNow() const {
    const Experiment& e = workspace().document().experiment();
    return {.sets = motionSets(workspace().motions().groups(), comparison()),
            .range = workspace().view().range(),
            .feet = e.feet,
            .footStepCmS = e.toleranceStepCmS,
            .seed = e.seed,
            .against = naturalChoiceByName(e.against)};
  }

  void start() {
    const StatisticsInput input = inputNow();
    if (input.sets.empty()) return;
    if (!m_shown)
      showHint(tr("Computing statistics of %1 ...").arg(QString::fromStdString(input.text())));
    compute<StatisticsTable>(
        tr("Computing statistics"),
        [input](Progress& progress) { return statisticsTable(input, progress); },
        [this](StatisticsTable& table) { show(std::move(table)); });
  }

  /// What the numbers belong to, and whether that is what is used now.
  void showInput(const StatisticsInput& now) {
    const bool current = m_shown->input.sameAs(now);
    QString what = QString::fromStdString(m_shown->input.text());
    // Sets may be compared with different natural motion.
    const std::set<std::string> natural(m_shown->compared.begin(), m_shown->compared.end());
    for (const std::string& text : natural)
      what += tr("; compared with %1").arg(QString::fromStdString(text));
    m_input->setText(current ? tr("Computed for: %1").arg(what)
                             : tr("<b>Out of date.</b> Computed for: %1. The motions have changed "
                                  "since; press \"Compute\".")
                                   .arg(what.toHtmlEscaped()));
    m_table->setEnabled(current);
  }

  void show(StatisticsTable table) {
    m_shown = std::move(table);
    m_recipe = recipe();
    QStringList header{tr("statistic"), tr("unit")};
    for (const std::string& system : m_shown->systems)
      header << QString::fromStdString(system) << tr("95 % interval");
    header << tr("natural") << tr("natural 95 %") << tr("noise floor");
    std::vector<std::vector<ValueCell>> cells;
    for (const StatisticsRow& row : m_shown->rows) cells.push_back(cellsOf(row));
    m_table->setRows(header, cells);
    m_copy->setEnabled(true);
    m_export->setEnabled(true);
    const StatisticsInput now = inputNow();
    showInput(now);
    showCounted(now.sets, m_shown->notes);
    showContent();
  }

  static std::vector<ValueCell> cellsOf(const StatisticsRow& row) {
    const QString definition = QStringLiteral("<p>%1</p><p><i>%2</i></p>")
                                   .arg(QString::fromStdString(row.definition).toHtmlEscaped(),
                                        QString::fromStdString(row.source).toHtmlEscaped());
    std::vector<ValueCell> cells{{QString::fromStdString(row.name), {}, definition},
                                 {QString::fromStdString(row.unit), {}, definition}};
    for (const auto& system : row.systems) {
      cells.push_back(valueCell(system ? std::optional(system->value) : std::nullopt, definition));
      cells.push_back(system ? intervalCell(system->low, system->high)
                             : intervalCell(std::nullopt, std::nullopt));
    }
    cells.push_back(valueCell(row.natural, definition));
    cells.push_back(intervalCell(row.naturalLow, row.naturalHigh));
    cells.push_back(valueCell(row.noiseFloor,
                              tr("Natural against natural, random halves: a difference below it "
                                 "says nothing.")));
    return cells;
  }

  void exportCsv() {
    const QString file =
        askSaveFile(this, tr("Export statistics"), QStringLiteral("statistics.csv"),
                    tr("CSV (*.csv)"), QStringLiteral("csv"));
    if (file.isEmpty()) return;
    try {
      writeFileAtomically(file.toStdString(), statisticsText(*m_shown, ','));
      writeFileAtomically(file.toStdString() + ".recipe.json",
                          render::toJson(m_recipe).dump(2) + "\n");
    } catch (const Error& error) {
      workspace().report(tr("The table was not saved"), QString::fromStdString(error.what()));
    }
  }

  QPushButton *m_compute = nullptr, *m_copy = nullptr, *m_export = nullptr;
  QLabel* m_input = nullptr;
  ValueTable* m_table = nullptr;
  std::optional<StatisticsTable> m_shown;
  render::Recipe m_recipe;  ///< of what is shown
};
}  // namespace

QWidget* makeStatisticsPanel(Workspace& workspace, QWidget* parent) {
  return new StatisticsPanel(workspace, parent);
}

}  // namespace marey::gui

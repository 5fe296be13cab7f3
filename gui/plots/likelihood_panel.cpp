#include "gui/plots/likelihood_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <map>
#include <tuple>

#include "gui/common/value_table.h"
#include "gui/plots/likelihood_data.h"
#include "gui/plots/plot_panel.h"

#include "model/pose_units.h"

namespace marey::gui {
namespace {
constexpr double kSmoothingS = 0.5;
constexpr int kTableHeight = 110;

class LikelihoodPanel : public PlotPanel {
 public:
  LikelihoodPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("likelihood"), true, parent) {
    m_view = new QComboBox(this);
    m_view->setObjectName(QStringLiteral("likelihoodView"));
    m_view->addItem(tr("Median and 5–95 %"));
    m_view->addItem(tr("Every motion"));
    m_smooth = new QCheckBox(tr("Running mean 0.5 s"), this);
    m_smooth->setObjectName(QStringLiteral("likelihoodSmooth"));
    m_score = new QPushButton(tr("Score natural motion"), this);
    m_score->setObjectName(QStringLiteral("likelihoodScoreNatural"));
    m_score->setToolTip(tr("Log-likelihood of the natural clips under every system, once"));
    m_worst = new QPushButton(tr("Worst frame"), this);
    m_worst->setObjectName(QStringLiteral("likelihoodWorstFrame"));
    m_worst->setToolTip(tr("Selects the motion with the least likely frame and goes there"));
    m_worstOf = new QComboBox(this);
    m_worstOf->setObjectName(QStringLiteral("likelihoodWorstOf"));
    m_worstOf->setToolTip(
        tr("The model whose worst frame is meant: likelihoods of several have no common scale"));
    m_worstOf->setMinimumContentsLength(4);
    m_worstOf->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    for (QWidget* tool :
         std::initializer_list<QWidget*>{m_view, m_smooth, m_score, m_worst, m_worstOf})
      tools()->addWidget(tool);
    tools()->insertStretch(2);
    chart()->setToolTip(tr("Log-likelihood per frame. Higher is more expected."));
    m_table = new ValueTable(this);
    m_table->setObjectName(QStringLiteral("likelihoodTable"));
    m_table->setMaximumHeight(kTableHeight);
    m_left = new QLabel(this);
    m_left->setObjectName(QStringLiteral("likelihoodLeftOut"));
    m_left->setWordWrap(true);
    content()->addWidget(m_table);
    content()->addWidget(m_left);
    connect(m_view, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            [this] { redraw(); });
    connect(m_smooth, &QCheckBox::toggled, this, [this] { redraw(); });
    connect(m_worstOf, QOverload<int>::of(&QComboBox::activated), this, [this] { redraw(); });
    connect(m_score, &QPushButton::clicked, this, [this] {
      for (const ExperimentSystem& system : this->workspace().document().experiment().systems)
        this->workspace().natural().score(system.name);
    });
    connect(m_worst, &QPushButton::clicked, this, [this] { goToWorst(); });
    connect(&workspace.natural(), &NaturalMotions::scoresChanged, this, [this] { refreshSoon(); });
  }

 protected:
  void refresh() override {
    const Workspace& w = workspace();
    std::vector<std::string> systems;
    bool unscored = false;
    for (const ExperimentSystem& system : w.document().experiment().systems) {
      systems.push_back(system.name);
      unscored = unscored || w.natural().scores(system.name) == nullptr;
    }
    const auto sets = motionSets(w.motions().groups());
    m_score->setEnabled(unscored && naturalSet(sets) != nullptr);
    m_groups = std::make_shared<const std::vector<LikelihoodGroup>>(likelihoodGroups(
        w.motions().groups(), systems,
        [&w](const std::string& system) { return w.natural().scores(system); },
        w.document().experiment().fps));
    m_pictures.clear();
    fillWorstOf();
    m_worst->setEnabled(m_worstOf->count() > 0);
    showCounted(sets, {notScoredText(*m_groups)});
    if (m_worstOf->count() == 0)
      return showHint(
          tr("No log-likelihoods yet: sample a path, or press \"Score natural motion\" "
             "to see the natural clips under the models."));
    m_models.clear();
    for (const ExperimentSystem& system : w.document().experiment().systems)
      m_models.emplace(system.name, w.document().modelFile(system));
    m_input = std::make_shared<const RowInput>(rowInput(systems));
    redraw();
  }

  std::vector<ChartHighlight> curvesOf(const std::set<MotionId>& picked) const override {
    // Where every motion is a line of its own, that one lights up.
    return everyMotion() || !m_shown ? std::vector<ChartHighlight>{}
                                     : likelihoodHighlights(m_shown->groups, picked);
  }

 private:
  /// What is drawn, worked out beside the event loop.
  struct Picture {
    std::vector<LikelihoodGroup> groups;
    std::vector<LikelihoodRow> rows;
    LinkedGrid grid;
  };
  /// What rows are made of, as values.
  struct RowInput {
    std::vector<MotionGroup> groups;
    std::vector<std::string> systems;
    std::map<std::string, std::vector<ClipScore>> natural;
  };

  RowInput rowInput(const std::vector<std::string>& systems) const {
    RowInput out{.groups = workspace().motions().groups(), .systems = systems, .natural = {}};
    for (const std::string& system : systems)
      if (const auto* scores = workspace().natural().scores(system)) out.natural[system] = *scores;
    return out;
  }
  using Kind = std::tuple<bool, bool, std::string>;  ///< every motion, smoothed, worst frame of

  bool everyMotion() const { return m_view->currentIndex() == 1; }

  std::string worstOf() const { return m_worstOf->currentText().toStdString(); }

  void fillWorstOf() {
    const QString before = m_worstOf->currentText();
    m_worstOf->clear();
    for (const std::string& system : systemsIn(*m_groups))
      m_worstOf->addItem(QString::fromStdString(system));
    m_worstOf->setCurrentIndex(std::max(0, m_worstOf->findText(before)));
    m_worstOf->setVisible(m_worstOf->count() > 1);
  }

  void redraw() {
    if (!m_groups || m_worstOf->count() == 0) return;
    const Kind kind{everyMotion(), m_smooth->isChecked(), worstOf()};
    if (const auto known = m_pictures.find(kind); known != m_pictures.end())
      return show(known->second);
    const Workspace* w = &workspace();
    compute<Picture>(
        tr("Drawing log-likelihoods"),
        [w, groups = m_groups, input = m_input, models = m_models, kind](Progress&) {
          Picture out{.groups = *groups, .rows = readRows(*w, *input, models), .grid = {}};
          const auto& [every, smoothed, system] = kind;
          if (smoothed) smooth(out.groups, kSmoothingS);
          out.grid = likelihoodGrid(out.groups, out.rows, every);
          if (const auto worst = worstFrame(*groups, std::nullopt, system))
            markWorst(out.grid, out.groups, *worst);
          return out;
        },
        [this, kind](Picture& picture) {
          const auto shared = std::make_shared<const Picture>(std::move(picture));
          m_pictures[kind] = shared;
          show(shared);
        });
  }

  static std::vector<LikelihoodRow> readRows(const Workspace& workspace, const RowInput& input,
                                             const std::map<std::string, std::string>& models) {
    return likelihoodRows(
        input.groups, input.systems,
        [&](const std::string& system) {
          const auto found = input.natural.find(system);
          return found == input.natural.end() ? nullptr : &found->second;
        },
        [&](const std::string& system) -> std::shared_ptr<const ModelInfo> {
          try {
            const auto model = workspace.models().model(models.at(system));
            return {model, &model->info()};
          } catch (const std::exception&) {
            // A model that cannot be read is reported where it is sampled; it has no row.
            return nullptr;
          }
        });
  }

  /// Densities of different values share no column: three columns for each unit.
  static QStringList headerOf(const std::vector<std::string>& units) {
    QStringList out{tr("motion"), tr("model")};
    for (const std::string& each : units) {
      const QString unit = QString::fromStdString(each);
      out << unit << tr("linear-Gaussian, %1").arg(unit)
          << tr("per effective dimension, %1").arg(QString::fromStdString(natsUnit(each)));
    }
    return out << tr("effective dimensions") << tr("on the floor") << tr("clips") << tr("frames")
               << tr("too short");
  }

  static std::vector<ValueCell> cellsOf(const LikelihoodRow& row,
                                        const std::vector<std::string>& units) {
    const LikelihoodSummary& s = row.summary;
    const QString floor = QString::fromStdString(row.floor);
    std::vector<ValueCell> out{{QString::fromStdString(row.name), std::nullopt, floor},
                               {QString::fromStdString(row.system), std::nullopt, floor}};
    for (const std::string& unit : units)
      for (const auto& [value, decimals] : {std::pair{s.nats, 1}, std::pair{s.linearGaussian, 1},
                                            std::pair{s.natsPerEffectiveDimension, 2}})
        out.push_back(unit == s.unit ? numberCell(value, decimals)
                                     : ValueCell{QString(), std::nullopt, QString()});
    for (const double value :
         {s.effectiveDimensions, s.floorDirections, static_cast<double>(s.clips),
          static_cast<double>(s.frames), static_cast<double>(s.tooShort.size())})
      out.push_back(numberCell(value, 0));
    return out;
  }

  void showRows(const std::vector<LikelihoodRow>& rows) {
    std::vector<std::string> units;
    for (const LikelihoodRow& row : rows)
      if (std::find(units.begin(), units.end(), row.summary.unit) == units.end())
        units.push_back(row.summary.unit);
    std::vector<std::vector<ValueCell>> cells;
    QStringList left;
    for (const LikelihoodRow& row : rows) {
      cells.push_back(cellsOf(row, units));
      if (!row.summary.tooShort.empty())
        left << QString::fromStdString(row.name + ", " + row.system + ": " +
                                       tooShortText(row.summary));
    }
    m_table->setRows(headerOf(units), cells);
    m_left->setText(left.join(QStringLiteral("\n")));
    m_left->setVisible(!left.isEmpty());
  }

  void show(const std::shared_ptr<const Picture>& picture) {
    m_shown = picture;
    showGrid(picture->grid);
    showRows(picture->rows);
  }

  void goToWorst() {
    const auto worst = worstFrame(*m_groups, workspace().view().range(), worstOf());
    if (!worst) return;
    selectMotions({worst->id}, false);
    workspace().view().setTime(worst->timeS);
  }

  QComboBox *m_view = nullptr, *m_worstOf = nullptr;
  QCheckBox* m_smooth = nullptr;
  QPushButton *m_score = nullptr, *m_worst = nullptr;
  std::shared_ptr<const std::vector<LikelihoodGroup>> m_groups;  ///< as scored
  std::map<Kind, std::shared_ptr<const Picture>> m_pictures;     ///< of these groups
  std::shared_ptr<const Picture> m_shown;
  std::shared_ptr<const RowInput> m_input;
  std::map<std::string, std::string> m_models;  ///< file of each system
  ValueTable* m_table = nullptr;
  QLabel* m_left = nullptr;  ///< what was too short
};
}  // namespace

QWidget* makeLikelihoodPanel(Workspace& workspace, QWidget* parent) {
  return new LikelihoodPanel(workspace, parent);
}

}  // namespace marey::gui

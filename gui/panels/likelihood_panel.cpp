#include "panels/likelihood_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QPushButton>
#include <set>

#include "panels/plot_panel.h"
#include "plots/likelihood_data.h"

#include "base/error.h"

namespace marey::gui {
namespace {
constexpr double kSmoothingS = 0.5;

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
    for (QWidget* tool : std::initializer_list<QWidget*>{m_view, m_smooth, m_score, m_worst})
      tools()->addWidget(tool);
    tools()->insertStretch(2);
    chart()->setToolTip(tr("Nats per frame, poses in metres. Higher is more expected."));
    connect(m_view, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            [this] { redraw(); });
    connect(m_smooth, &QCheckBox::toggled, this, [this] { redraw(); });
    connect(m_score, &QPushButton::clicked, this, [this] {
      for (const ExperimentSystem& system : this->workspace().experiment().systems)
        this->workspace().scoreNatural(system.name);
    });
    connect(m_worst, &QPushButton::clicked, this, [this] { goToWorst(); });
    connect(&workspace, &Workspace::naturalScoresChanged, this, [this] { refreshSoon(); });
  }

 protected:
  void refresh() override {
    const Workspace& w = workspace();
    std::vector<std::string> systems;
    bool unscored = false;
    for (const ExperimentSystem& system : w.experiment().systems) {
      systems.push_back(system.name);
      unscored = unscored || w.naturalScores(system.name) == nullptr;
    }
    const auto sets = motionSets(w.groups());
    m_score->setEnabled(unscored && naturalSet(sets) != nullptr);
    m_groups = likelihoodGroups(
        w.groups(), systems, [&w](const std::string& system) { return w.naturalScores(system); },
        w.experiment().fps);
    m_worst->setEnabled(!m_groups.empty());
    if (m_groups.empty()) {
      m_floorFiles.clear();  // the hint ends a reading of floors
      return showHint(
          tr("No log-likelihoods yet: sample a path, or press \"Score natural motion\" "
             "to see the natural clips under the models."));
    }
    readFloors(sets);
    redraw();
  }

  void selectionMoved() override { showSelected(); }

 private:
  /// Models are read beside the event loop; their floors then join the picture.
  void readFloors(const std::vector<MotionSet>& sets) {
    std::set<std::string> wanted;
    for (const MotionSet& set : sets)
      if (!set.natural) wanted.insert(set.system);
    std::vector<std::pair<std::string, std::string>> files;
    for (const ExperimentSystem& system : workspace().experiment().systems)
      if (wanted.contains(system.name))
        files.emplace_back(system.name, workspace().modelFile(system));
    if (files == m_floorFiles) return;
    m_floorFiles = files;
    m_floors.clear();
    const Workspace* w = &workspace();
    compute<std::vector<LikelihoodFloor>>(
        tr("Reading likelihood floors"),
        [w, files](Progress&) {
          std::vector<LikelihoodFloor> floors;
          for (const auto& [system, file] : files) {
            try {
              if (const auto nats = linearGaussianFloor(w->model(file)->info()))
                floors.push_back({system, *nats});
            } catch (const Error&) {
              // A model that cannot be read is reported where it is sampled; it has no floor.
            }
          }
          return floors;
        },
        [this](std::vector<LikelihoodFloor>& floors) {
          m_floors = std::move(floors);
          redraw();
        });
  }

  void redraw() {
    if (m_groups.empty()) return;
    m_shown = m_groups;
    if (m_smooth->isChecked()) smooth(m_shown, kSmoothingS);
    showGrid(likelihoodGrid(m_shown, m_floors, m_view->currentIndex() == 1));
    showSelected();
  }

  /// Single motions are no curves of the median view: they are laid over it.
  void showSelected() {
    constexpr size_t kMost = 24;
    std::vector<ChartHighlight> highlights;
    for (const LikelihoodGroup& group : m_shown)
      for (const LikelihoodRun& run : group.runs) {
        if (!workspace().selected(run.id) || highlights.size() >= kMost) continue;
        ChartHighlight one{.chart = 0, .y = run.nats, .colour = group.look.colour};
        for (size_t i = 0; i < run.nats.size(); ++i)
          one.x.push_back((run.firstFrame + static_cast<double>(i)) / group.fps);
        highlights.push_back(std::move(one));
      }
    chart()->setHighlights(std::move(highlights));
  }

  void goToWorst() {
    const auto worst = worstFrame(m_groups, workspace().range());
    if (!worst) return;
    selectMotions({worst->id}, false);
    workspace().setTime(worst->timeS);
  }

  QComboBox* m_view = nullptr;
  QCheckBox* m_smooth = nullptr;
  QPushButton *m_score = nullptr, *m_worst = nullptr;
  std::vector<LikelihoodGroup> m_groups, m_shown;  ///< as scored; as drawn
  std::vector<LikelihoodFloor> m_floors;
  std::vector<std::pair<std::string, std::string>> m_floorFiles;
};
}  // namespace

QWidget* makeLikelihoodPanel(Workspace& workspace, QWidget* parent) {
  return new LikelihoodPanel(workspace, parent);
}

}  // namespace marey::gui

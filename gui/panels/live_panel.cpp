#include "panels/live_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QFormLayout>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "panels/live_session.h"
#include "panels/paint_style.h"
#include "panels/stick_view.h"

namespace marey::gui {
namespace {

constexpr int kDrawEveryMs = 16, kSceneEveryMs = 50;
constexpr size_t kLatencies = 400;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

class LivePanel : public QWidget {
 public:
  LivePanel(Workspace& workspace, QWidget* parent) : QWidget(parent), m_workspace(workspace) {
    setFocusPolicy(Qt::StrongFocus);
    setProperty("keys", QStringList{tr("Arrow keys\tLive: walk and turn (panel in focus)"),
                                    tr("Shift+Left, Shift+Right\tLive: walk sideways")});
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
    m_view = new StickView(this);
    m_view->setObjectName(QStringLiteral("liveView"));
    m_view->setHint(tr("Start, then steer with the arrow keys; with Shift, sideways."));
    // Side by side: docks are wide rather than high.
    auto* controls = new QVBoxLayout;
    controls->addLayout(buildForm());
    controls->addLayout(buildPad());
    controls->addStretch(1);
    auto* row = new QHBoxLayout;
    row->addWidget(m_view, 1);
    row->addLayout(controls);
    layout->addLayout(row, 1);
    layout->addLayout(buildButtons());
    m_latency = new QLabel(this);
    m_latency->setObjectName(QStringLiteral("liveLatency"));
    m_latency->setWordWrap(true);
    layout->addWidget(m_latency);
    m_timer.setInterval(kDrawEveryMs);
    connect(&m_timer, &QTimer::timeout, this, &LivePanel::takeNews);
    connect(&workspace, &Workspace::documentChanged, this, &LivePanel::refresh);
    refresh();
  }

 protected:
  bool event(QEvent* event) override {
    // Arrow keys are shortcuts of the window otherwise (frame by frame).
    if (event->type() == QEvent::ShortcutOverride && m_session &&
        steers(static_cast<QKeyEvent*>(event)->key())) {
      event->accept();
      return true;
    }
    return QWidget::event(event);
  }

  void keyPressEvent(QKeyEvent* event) override {
    if (!steers(event->key())) return QWidget::keyPressEvent(event);
    m_keys.insert(event->key());
    steer(event->modifiers().testFlag(Qt::ShiftModifier) || event->key() == Qt::Key_Shift);
  }

  void keyReleaseEvent(QKeyEvent* event) override {
    if (!steers(event->key())) return QWidget::keyReleaseEvent(event);
    if (!event->isAutoRepeat()) m_keys.erase(event->key());
    steer(event->modifiers().testFlag(Qt::ShiftModifier) && event->key() != Qt::Key_Shift);
  }

  void focusOutEvent(QFocusEvent* event) override {
    m_keys.clear();  // their release goes elsewhere
    steer(false);
    QWidget::focusOutEvent(event);
  }

 private:
  static bool steers(int key) {
    return key == Qt::Key_Up || key == Qt::Key_Down || key == Qt::Key_Left ||
           key == Qt::Key_Right || key == Qt::Key_Shift;
  }

  QDoubleSpinBox* number(const char* name, double value, double most, const QString& unit) {
    auto* box = new QDoubleSpinBox(this);
    box->setObjectName(QLatin1String(name));
    box->setRange(0.0, most);
    box->setSingleStep(most / 40.0);
    box->setValue(value);
    box->setSuffix(unit);
    return box;
  }

  QLayout* buildForm() {
    auto* form = new QFormLayout;
    m_models = new QComboBox(this);
    m_models->setObjectName(QStringLiteral("liveModels"));
    m_speed = number("liveSpeed", 1.2, 4.0, tr(" m/s"));
    m_sideways = number("liveSideways", 0.5, 4.0, tr(" m/s"));
    m_turn = number("liveTurn", 60.0, 360.0, tr(" °/s"));
    m_inScene = new QCheckBox(tr("Show in the scene"), this);
    m_inScene->setObjectName(QStringLiteral("liveInScene"));
    m_inScene->setChecked(true);
    form->addRow(tr("Model"), m_models);
    form->addRow(tr("Speed"), m_speed);
    form->addRow(tr("Sideways"), m_sideways);
    form->addRow(tr("Turn"), m_turn);
    form->addRow({}, m_inScene);
    return form;
  }

  /// A pad for the mouse: arrows, and sideways in the lower corners.
  QLayout* buildPad() {
    auto* grid = new QGridLayout;
    struct Button {
      const char* name;
      QString text, tip;
      int row, column, key;
      bool shift;
    };
    const Button buttons[] = {
        {"livePadUp", QStringLiteral("▲"), tr("Forward"), 0, 1, Qt::Key_Up, false},
        {"livePadLeft", QStringLiteral("↶"), tr("Turn left"), 1, 0, Qt::Key_Left, false},
        {"livePadDown", QStringLiteral("▼"), tr("Backward"), 1, 1, Qt::Key_Down, false},
        {"livePadRight", QStringLiteral("↷"), tr("Turn right"), 1, 2, Qt::Key_Right, false},
        {"livePadSideLeft", QStringLiteral("◀"), tr("Sideways left"), 2, 0, Qt::Key_Left, true},
        {"livePadSideRight", QStringLiteral("▶"), tr("Sideways right"), 2, 2, Qt::Key_Right, true}};
    for (const Button& b : buttons) {
      auto* button = new QToolButton(this);
      button->setObjectName(QLatin1String(b.name));
      button->setText(b.text);
      button->setToolTip(b.tip);
      button->setAccessibleName(b.tip);
      button->setFocusPolicy(Qt::NoFocus);
      button->setMinimumSize(34, 24);
      grid->addWidget(button, b.row, b.column);
      connect(button, &QToolButton::pressed, this, [this, key = b.key, shift = b.shift] {
        m_keys.insert(key);
        steer(shift);
      });
      connect(button, &QToolButton::released, this, [this, key = b.key] {
        m_keys.erase(key);
        steer(false);
      });
    }
    return grid;
  }

  QLayout* buildButtons() {
    m_start = new QPushButton(this);
    m_start->setObjectName(QStringLiteral("liveStart"));
    m_keep = new QPushButton(tr("Keep"), this);
    m_keep->setObjectName(QStringLiteral("liveKeep"));
    m_keep->setToolTip(tr("Stop, and keep the motion as a pinned set with its path"));
    connect(m_start, &QPushButton::clicked, this, [this] { m_session ? stop() : start(); });
    connect(m_keep, &QPushButton::clicked, this, &LivePanel::keep);
    auto* row = new QHBoxLayout;
    row->addWidget(m_start, 1);
    row->addWidget(m_keep);
    return row;
  }

  void steer(bool sideways) {
    const auto held = [this](int key) { return m_keys.contains(key) ? 1.0 : 0.0; };
    const double ahead = held(Qt::Key_Up) - held(Qt::Key_Down);
    const double left = held(Qt::Key_Left) - held(Qt::Key_Right);
    if (m_session)
      m_session->setCommand(
          {.forwardMS = ahead * m_speed->value(),
           .sidewaysMS = sideways ? left * m_sideways->value() : 0.0,
           .turnRadS = sideways ? 0.0 : left * m_turn->value() * std::numbers::pi / 180.0});
  }

  void start() {
    const Experiment& e = m_workspace.experiment();
    dropLiveGroups();
    m_systems.clear();
    std::vector<LiveModel> models;
    for (size_t i = 0; i < e.systems.size(); ++i) {
      if (m_models->currentIndex() > 0 && static_cast<int>(i) != m_models->currentIndex() - 1)
        continue;
      const std::string file = m_workspace.modelFile(e.systems[i]);
      models.push_back({e.systems[i].name, [this, file] { return m_workspace.model(file); },
                        e.systems[i].temperature});
      m_systems.push_back(e.systems[i]);
    }
    m_seed = e.seed;
    m_clips.assign(models.size(), {});
    m_latencies.clear();
    m_session = std::make_unique<LiveSession>(std::move(models), LiveOptions{.seed = m_seed});
    m_kept.reset();
    m_latency->setText(tr("Loading…"));
    m_sinceScene.start();
    m_timer.start();
    setFocus();
    refresh();
  }

  void stop() {
    if (!m_session) return;
    m_timer.stop();
    m_session->stop();
    takeFrames();
    m_kept = std::move(m_session);
    showInScene();
    refresh();
  }

  void takeNews() {
    const std::string error = takeFrames();
    if (!error.empty()) {
      stop();
      m_workspace.report(tr("Live control"), QString::fromStdString(error));
      return;
    }
    showLatency();
    if (!m_clips.empty() && !m_clips.front().positions.empty()) showFigures();
    // What the other views cost is theirs to say: at most half of the time goes to them.
    if (m_inScene->isChecked() && m_sinceScene.hasExpired(std::max(kSceneEveryMs, 2 * m_sceneMs)))
      showInScene();
  }

  std::string takeFrames() {
    const LiveNews news = m_session->take();
    m_heading = news.heading;
    for (size_t i = 0; i < news.frames.size(); ++i) {
      Clip& clip = m_clips[i];
      clip.name = fmt::format("live_{:03}", i);
      clip.skeleton = news.skeleton;
      clip.fps = news.fps;
      for (const auto& frame : news.frames[i])
        clip.positions.insert(clip.positions.end(), frame.begin(), frame.end());
    }
    m_latencies.insert(m_latencies.end(), news.latencyMs.begin(), news.latencyMs.end());
    while (m_latencies.size() > kLatencies) m_latencies.pop_front();
    return news.error;
  }

  void showFigures() {
    std::vector<StickFigure> figures;
    for (size_t i = 0; i < m_clips.size(); ++i) {
      const Clip& clip = m_clips[i];
      if (clip.positions.empty()) continue;
      const auto frame = clip.frame(clip.frameCount() - 1);
      const QColor ink = m_clips.size() == 1 ? QColor() : colourAt(i);
      figures.push_back({clip.skeleton, {frame.begin(), frame.end()}, ink});
    }
    // From behind, turning along slowly, so that left is left.
    constexpr double kFollow = 0.06, kElevation = 0.35;
    m_yaw += kFollow * std::remainder(m_heading + std::numbers::pi - m_yaw, 2 * std::numbers::pi);
    m_view->setDirection(m_yaw, kElevation);
    m_view->setFigures(std::move(figures));
  }

  int colourIndexAt(size_t i) const {
    return std::max(0, m_workspace.systemIndex(m_systems[i].name));
  }
  QColor colourAt(size_t i) const {
    return shownColour(render::colourOf(colourIndexAt(i)), isDark(palette()));
  }

  void showLatency() {
    if (m_latencies.empty()) return;
    const std::vector<double> all(m_latencies.begin(), m_latencies.end());
    const double median = quantile(all, 0.5);
    m_latency->setText(
        tr("%1 ms per frame (median), %2 ms (95 %) – up to %3 frames/s; played at %4")
            .arg(median, 0, 'f', 1)
            .arg(quantile(all, 0.95), 0, 'f', 1)
            .arg(1000.0 / std::max(median, 1e-3), 0, 'f', 0)
            .arg(m_clips.front().fps, 0, 'g', 4));
  }

  void showInScene() {
    if (!m_inScene->isChecked()) return;
    QElapsedTimer clock;
    clock.start();
    for (size_t i = 0; i < m_clips.size(); ++i) {
      if (m_clips[i].positions.empty()) continue;
      const std::vector<Motion> motions{{std::make_shared<const Clip>(m_clips[i]), {}, true}};
      if (i < m_groups.size() && m_workspace.group(m_groups[i]) != nullptr)
        m_workspace.setMotions(m_groups[i], motions);
      else if (i >= m_groups.size())
        m_groups.push_back(m_workspace.addGroup({.name = "Live – " + m_systems[i].name,
                                                 .system = m_systems[i].name,
                                                 .colourIndex = colourIndexAt(i),
                                                 .pinned = true,
                                                 .complete = false,
                                                 .recipe = {},
                                                 .modelHash = {},
                                                 .wanted = {},
                                                 .motions = motions}));
    }
    if (m_clips.front().frameCount() > 0) m_workspace.setTime(m_clips.front().seconds());
    m_sceneMs = static_cast<int>(clock.elapsed());
    m_sinceScene.start();
  }

  void dropLiveGroups() {
    for (const int group : m_groups) m_workspace.removeGroup(group);
    m_groups.clear();
  }

  /// Scores the motions and puts them where the live groups were.
  void keep() {
    stop();
    if (!m_kept) return;
    auto groups = std::make_shared<std::vector<MotionGroup>>();
    const Experiment& e = m_workspace.experiment();
    const auto base = SampleRecipe{
        .system = {}, .path = {}, .samples = 1, .seed = m_seed, .fps = e.fps, .folder = e.folder};
    std::vector<int> colours;
    for (size_t i = 0; i < m_systems.size(); ++i) colours.push_back(colourIndexAt(i));
    const QPointer<LivePanel> self(this);
    m_workspace.jobs().start(
        Lane::Models, tr("Keeping the steered motion"),
        [groups, base, colours, systems = m_systems, session = m_kept](Progress& progress) {
          for (size_t i = 0; i < session->rollouts().size(); ++i) {
            progress.throwIfCancelled();
            groups->push_back(keptGroup(session->rollouts()[i], systems[i], base, colours[i]));
          }
        },
        [self, groups, workspace = &m_workspace] {
          if (self) self->dropLiveGroups();
          for (MotionGroup& group : *groups) workspace->addGroup(std::move(group));
        });
    m_kept.reset();
    refresh();
  }

  void refresh() {
    const auto& systems = m_workspace.experiment().systems;
    const auto gone = [this](const ExperimentSystem& s) {
      return m_workspace.systemIndex(s.name) < 0;
    };
    if (m_session && std::any_of(m_systems.begin(), m_systems.end(), gone)) stop();
    if (m_models->count() != static_cast<int>(systems.size()) + 1) m_models->clear();
    if (m_models->count() == 0) {
      m_models->addItem(tr("All models"));
      for (const ExperimentSystem& system : systems)
        m_models->addItem(QString::fromStdString(system.name));
    }
    for (size_t i = 0; i < systems.size(); ++i)
      m_models->setItemText(static_cast<int>(i) + 1, QString::fromStdString(systems[i].name));
    m_models->setEnabled(!m_session);
    m_start->setText(m_session ? tr("Stop") : tr("Start"));
    m_start->setEnabled(m_session || !systems.empty());
    const bool anything = !m_clips.empty() && m_clips.front().frameCount() > 1;
    m_keep->setEnabled(m_session || (m_kept && anything));
  }

  Workspace& m_workspace;
  StickView* m_view = nullptr;
  QComboBox* m_models = nullptr;
  QDoubleSpinBox* m_speed = nullptr;
  QDoubleSpinBox* m_sideways = nullptr;
  QDoubleSpinBox* m_turn = nullptr;
  QCheckBox* m_inScene = nullptr;
  QPushButton* m_start = nullptr;
  QPushButton* m_keep = nullptr;
  QLabel* m_latency = nullptr;
  QTimer m_timer;
  std::set<int> m_keys;  ///< held down
  std::vector<ExperimentSystem> m_systems;
  uint64_t m_seed = 1;
  std::vector<Clip> m_clips;
  std::vector<int> m_groups;  ///< of the workspace, one per model
  std::deque<double> m_latencies;
  QElapsedTimer m_sinceScene;
  int m_sceneMs = 0;
  double m_heading = 0.0, m_yaw = std::numbers::pi;
  std::shared_ptr<LiveSession> m_kept;  ///< ended, and may still be kept
  std::unique_ptr<LiveSession> m_session;
};

}  // namespace

QWidget* makeLivePanel(Workspace& workspace, QWidget* parent) {
  return new LivePanel(workspace, parent);
}

}  // namespace marey::gui

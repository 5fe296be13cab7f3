#include "gui/steer/live_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QElapsedTimer>
#include <QFormLayout>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "gui/common/paint_style.h"
#include "gui/common/stick_view.h"
#include "gui/steer/live_controls.h"

#include "base/quantile.h"
#include "experiment/steering/live_session.h"

namespace marey::gui {
namespace {

constexpr int kDrawEveryMs = 16, kSceneEveryMs = 50;
constexpr size_t kRemembered = 400;
/// Of a session that goes on, the scene shows this much: its cost then does not grow.
constexpr double kSceneS = 20.0;
/// Frames come a little late at times; a rate this close to the wanted one is held.
constexpr double kHeld = 0.95;

double quantileOf(const std::deque<double>& values, double share) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sortedQuantile(sorted, share);
}

void remember(std::deque<double>& values, double value) {
  values.push_back(value);
  if (values.size() > kRemembered) values.pop_front();
}

class LivePanel : public QWidget {
 public:
  LivePanel(Workspace& workspace, QWidget* parent) : QWidget(parent), m_workspace(workspace) {
    setFocusPolicy(Qt::StrongFocus);
    setProperty("keys", QStringList{tr("Arrow keys\tLive: walk and turn, while a session runs"),
                                    tr("Shift+Left, Shift+Right\tLive: walk sideways"),
                                    tr("Ctrl+Left, Ctrl+Right\tLive: look aside")});
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
    m_view = new StickView(this);
    m_view->setObjectName(QStringLiteral("liveView"));
    m_view->setHint(tr("Start, then steer with the arrow keys or a gamepad."));
    // Side by side: docks are wide rather than high.
    auto* controls = new QVBoxLayout;
    controls->addLayout(buildForm());
    m_controls = new LiveControls(this);
    controls->addWidget(m_controls);
    controls->addStretch(1);
    auto* row = new QHBoxLayout;
    row->addWidget(m_view, 1);
    row->addLayout(controls);
    layout->addLayout(row, 1);
    layout->addLayout(buildButtons());
    m_rate = new QLabel(this);
    m_rate->setObjectName(QStringLiteral("liveLatency"));
    m_rate->setWordWrap(true);
    layout->addWidget(m_rate);
    m_timer.setInterval(kDrawEveryMs);
    connect(&m_timer, &QTimer::timeout, this, &LivePanel::takeNews);
    connect(&workspace.document(), &Document::changed, this, &LivePanel::refresh);
    connect(&workspace, &Workspace::opened, this, &LivePanel::forget);
    connect(m_controls, &LiveControls::changed, this, &LivePanel::steer);
    refresh();
  }

 private:
  QLayout* buildForm() {
    auto* form = new QFormLayout;
    m_models = new QComboBox(this);
    m_models->setObjectName(QStringLiteral("liveModels"));
    m_inScene = new QCheckBox(tr("Show in the scene"), this);
    m_inScene->setObjectName(QStringLiteral("liveInScene"));
    m_inScene->setChecked(true);
    form->addRow(tr("Model"), m_models);
    form->addRow({}, m_inScene);
    return form;
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

  void steer() {
    if (m_session) m_session->setCommand(m_controls->command(), m_controls->fullDeflection());
  }

  void start() {
    const Experiment& e = m_workspace.document().experiment();
    dropLiveGroups();
    m_systems.clear();
    std::vector<LiveModel> models;
    for (size_t i = 0; i < e.systems.size(); ++i) {
      if (m_models->currentIndex() > 0 && static_cast<int>(i) != m_models->currentIndex() - 1)
        continue;
      const std::string file = m_workspace.document().modelFile(e.systems[i]);
      models.push_back({e.systems[i].name,
                        [this, file] { return m_workspace.models().model(file); },
                        e.systems[i].temperature, e.systems[i].options});
      m_systems.push_back(e.systems[i]);
    }
    m_seed = e.seed;
    m_typesShown = false;
    m_controls->setTypes({});
    m_clips.assign(models.size(), {});
    m_frameMs.assign(models.size(), {});
    m_latencies.clear();
    m_kept.reset();
    m_session = std::make_shared<LiveSession>(std::move(models), LiveOptions{.seed = m_seed});
    m_rate->setText(tr("Loading…"));
    m_sinceScene.start();
    m_timer.start();
    m_controls->setSteering(true);
    steer();
    setFocus();
    refresh();
  }

  /// Ends the session without waiting for its thread; what it has made until then may be kept.
  void stop() {
    if (!m_session) return;
    m_timer.stop();
    m_controls->setSteering(false);
    m_session->requestStop();
    takeFrames();
    m_kept = std::move(m_session);
    showInScene();
    endBeside(m_kept);
    refresh();
  }

  /// The last holder of a session waits for its thread: that must not be the window.
  void endBeside(const std::shared_ptr<LiveSession>& session) {
    m_workspace.jobs().start(Lane::Files, tr("Ending live control"),
                             [session](Progress&) { session->stop(); });
  }

  /// Another document: nothing of the old one's session goes on or may be kept.
  void forget() {
    m_groups.clear();  // gone with the old document
    if (m_session) {
      m_timer.stop();
      m_controls->setSteering(false);
      m_session->requestStop();
      endBeside(m_session);
    }
    m_session.reset();
    m_kept.reset();
    m_clips.clear();
    m_rate->clear();
    m_view->setFigures({});
    refresh();
  }

  void takeNews() {
    const LiveNews news = takeFrames();
    if (!news.error.empty()) {
      stop();
      m_workspace.report(tr("Live control"), QString::fromStdString(news.error));
      return;
    }
    if (!m_clips.empty() && !m_clips.front().positions.empty()) showFigures();
    if (!news.types.empty() && !m_typesShown) m_controls->setTypes(news.types);
    m_typesShown = !news.types.empty();
    if (news.commandAt) {
      m_view->repaint();  // now: the time until the picture stands is what is measured
      remember(
          m_latencies,
          std::chrono::duration<double, std::milli>(LiveClock::now() - *news.commandAt).count());
    }
    showRates(news);
    // What the other views cost is theirs to say: at most half of the time goes to them.
    if (m_inScene->isChecked() && m_sinceScene.hasExpired(std::max(kSceneEveryMs, 2 * m_sceneMs)))
      showInScene();
  }

  LiveNews takeFrames() {
    LiveNews news = m_session->take();
    m_heading = news.heading;
    for (size_t i = 0; i < news.models.size(); ++i) {
      Clip& clip = m_clips[i];
      clip.name = fmt::format("live_{:03}", i);
      clip.skeleton = news.models[i].skeleton;
      clip.fps = news.fps;
      for (const auto& frame : news.models[i].frames)
        clip.positions.insert(clip.positions.end(), frame.begin(), frame.end());
      for (const double ms : news.models[i].frameMs) remember(m_frameMs[i], ms);
    }
    return news;
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
    return std::max(0, m_workspace.document().systemIndex(m_systems[i].name));
  }
  QColor colourAt(size_t i) const {
    return shownColour(render::colourOf(colourIndexAt(i)), isDark(palette()));
  }

  void showRates(const LiveNews& news) {
    if (news.fps <= 0.0 || m_frameMs.front().empty()) return;
    QStringList parts;
    for (size_t i = 0; i < m_frameMs.size(); ++i)
      parts << tr("%1: up to %2 frames/s")
                   .arg(QString::fromStdString(m_systems[i].name))
                   .arg(1000.0 / std::max(quantileOf(m_frameMs[i], 0.5), 1e-3), 0, 'f', 0);
    parts << (news.madePerS >= kHeld * news.fps
                  ? tr("%1 frames/s are held").arg(news.fps, 0, 'g', 4)
                  : tr("<b>%1 of %2 frames/s</b>: time is stretched")
                        .arg(news.madePerS, 0, 'f', 1)
                        .arg(news.fps, 0, 'g', 4));
    if (!m_latencies.empty())
      parts << tr("command to picture %1 ms (median), %2 ms (95 %)")
                   .arg(quantileOf(m_latencies, 0.5), 0, 'f', 0)
                   .arg(quantileOf(m_latencies, 0.95), 0, 'f', 0);
    if (news.gamepad) parts << tr("gamepad connected");
    m_rate->setText(parts.join(QStringLiteral(" · ")));
  }

  /// All of an ended session, and the last seconds of one that goes on.
  Clip shownPart(const Clip& clip) const {
    const int frames = clip.frameCount();
    const int most = m_session ? static_cast<int>(kSceneS * clip.fps) : frames;
    return frames > most ? sliceFrames(clip, frames - most, frames) : clip;
  }

  void showInScene() {
    if (!m_inScene->isChecked()) return;
    QElapsedTimer clock;
    clock.start();
    double endS = 0.0;
    for (size_t i = 0; i < m_clips.size(); ++i) {
      if (m_clips[i].positions.empty()) continue;
      const std::vector<Motion> motions{
          {std::make_shared<const Clip>(shownPart(m_clips[i])), {}, true}};
      endS = std::max(endS, (motions.front().clip->frameCount() - 1) / motions.front().clip->fps);
      if (i < m_groups.size() && m_workspace.motions().group(m_groups[i]) != nullptr)
        m_workspace.motions().setMotions(m_groups[i], motions);
      else if (i >= m_groups.size())
        m_groups.push_back(m_workspace.motions().add({.name = "Live – " + m_systems[i].name,
                                                      .system = m_systems[i].name,
                                                      .colourIndex = colourIndexAt(i),
                                                      .pinned = true,
                                                      .complete = false,
                                                      .recipe = {},
                                                      .modelHash = {},
                                                      .wanted = {},
                                                      .motions = motions}));
    }
    if (endS > 0.0) m_workspace.view().setTime(endS);
    m_sceneMs = static_cast<int>(clock.elapsed());
    m_sinceScene.start();
  }

  void dropLiveGroups() {
    for (const int group : m_groups) m_workspace.motions().remove(group);
    m_groups.clear();
  }

  /// Scores the motions and puts them where the live groups were.
  void keep() {
    stop();
    if (!m_kept) return;
    auto groups = std::make_shared<std::vector<MotionGroup>>();
    const Experiment& e = m_workspace.document().experiment();
    const auto base = SampleRecipe{
        .system = {}, .path = {}, .samples = 1, .seed = m_seed, .fps = e.fps, .folder = e.folder};
    std::vector<int> colours;
    for (size_t i = 0; i < m_systems.size(); ++i) colours.push_back(colourIndexAt(i));
    const QPointer<LivePanel> self(this);
    m_workspace.jobs().start(
        Lane::Models, tr("Keeping the steered motion"),
        [groups, base, colours, systems = m_systems, session = m_kept](Progress& progress) {
          session->stop();
          for (size_t i = 0; i < session->rollouts().size(); ++i) {
            progress.throwIfCancelled();
            groups->push_back(keptGroup(session->rollouts()[i], systems[i], base, colours[i]));
          }
        },
        [self, groups, workspace = &m_workspace] {
          if (self) self->dropLiveGroups();
          for (MotionGroup& group : *groups) workspace->motions().add(std::move(group));
        });
    m_kept.reset();
    refresh();
  }

  void refresh() {
    const auto& systems = m_workspace.document().experiment().systems;
    const auto gone = [this](const ExperimentSystem& s) {
      return m_workspace.document().systemIndex(s.name) < 0;
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
  LiveControls* m_controls = nullptr;
  bool m_typesShown = false;  ///< those of the models that run
  QCheckBox* m_inScene = nullptr;
  QPushButton* m_start = nullptr;
  QPushButton* m_keep = nullptr;
  QLabel* m_rate = nullptr;
  QTimer m_timer;
  std::vector<ExperimentSystem> m_systems;
  uint64_t m_seed = 1;
  std::vector<Clip> m_clips;
  std::vector<int> m_groups;                  ///< of the workspace, one per model
  std::vector<std::deque<double>> m_frameMs;  ///< of every model
  std::deque<double> m_latencies;             ///< from a command to its picture, ms
  QElapsedTimer m_sinceScene;
  int m_sceneMs = 0;
  double m_heading = 0.0, m_yaw = std::numbers::pi;
  std::shared_ptr<LiveSession> m_kept;  ///< ended, and may still be kept
  std::shared_ptr<LiveSession> m_session;
};

}  // namespace

QWidget* makeLivePanel(Workspace& workspace, QWidget* parent) {
  return new LivePanel(workspace, parent);
}

}  // namespace marey::gui

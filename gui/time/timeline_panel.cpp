#include "gui/time/timeline_panel.h"

#include <QAction>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>
#include <cmath>

#include "gui/common/number_box.h"
#include "gui/plots/workspace_chart.h"
#include "gui/time/playback.h"
#include "gui/time/time_ruler.h"
#include "gui/time/transport_icons.h"

namespace marey::gui {
namespace {

class TimelinePanel : public QWidget {
 public:
  TimelinePanel(Workspace& workspace, QWidget* parent)
      : QWidget(parent),
        m_workspace(workspace),
        m_gaitRows(workspace),
        m_playback(new Playback(workspace, this)) {
    setObjectName(QStringLiteral("timelinePanel"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addLayout(buildBar());
    m_ruler = new TimeRuler(workspace, this);
    layout->addWidget(m_ruler);
    m_gait = new GaitView(workspace, *m_ruler, this);
    new ChartMenu(
        m_gait, chartOutOf(workspace, QStringLiteral("gait"), [this] { return m_gait->chart(); }));
    auto* scroll = new QScrollArea(this);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setWidgetResizable(true);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    scroll->setWidget(m_gait);
    layout->addWidget(scroll, 1);
    connectWorkspace();
    updateRows();
    updateTime();
  }

 protected:
  void changeEvent(QEvent* event) override {
    QWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange && m_end) drawIcons();
  }

 private:
  QToolButton* button(QHBoxLayout* bar, const char* name, const QString& text,
                      const QString& toolTip, const QList<QKeySequence>& keys,
                      Qt::ShortcutContext context, const std::function<void()>& run) {
    auto* action = new QAction(text, this);
    action->setObjectName(QLatin1String(name) + "Action");
    action->setShortcuts(keys);
    action->setShortcutContext(context);
    QStringList names;
    for (const QKeySequence& key : keys) names << key.toString(QKeySequence::NativeText);
    action->setToolTip(keys.isEmpty() ? toolTip
                                      : QStringLiteral("%1 (%2)").arg(toolTip, names.join(" ")));
    connect(action, &QAction::triggered, this, run);
    addAction(action);
    auto* out = new QToolButton(this);
    out->setObjectName(QLatin1String(name));
    out->setDefaultAction(action);
    out->setAutoRaise(true);
    // A click here leaves the keys where they were.
    out->setFocusPolicy(Qt::TabFocus);
    bar->addWidget(out);
    return out;
  }

  QLayout* buildBar() {
    auto* bar = new QHBoxLayout;
    bar->setContentsMargins(kMargin, 4, kMargin, 4);
    bar->setSpacing(kSpacing);
    addTransport(bar);
    m_label = new QLabel(this);
    m_label->setObjectName(QStringLiteral("timelineLabel"));
    m_label->setFont(readableFont(font()));
    bar->addWidget(m_label);
    addFrameBox(bar);
    bar->addStretch(1);
    addSpeed(bar);
    addTolerance(bar);
    m_clear =
        button(bar, "timelineClearRange", tr("Clear range"), tr("All of the time counts again"), {},
               Qt::WindowShortcut, [this] { m_workspace.view().setRange(std::nullopt); });
    m_clear->defaultAction()->setIconText(tr("Clear range"));
    return bar;
  }

  void addTransport(QHBoxLayout* bar) {
    constexpr auto kHere = Qt::WidgetWithChildrenShortcut;
    m_home = button(bar, "timelineHome", tr("To the start"), tr("To the start"), {Qt::Key_Home},
                    kHere, [this] { m_playback->goTo(m_playback->bounds().beginS); });
    m_back = button(bar, "timelineBack", tr("Frame back"), tr("One frame back"),
                    {Qt::Key_Comma, Qt::Key_BracketLeft}, Qt::WindowShortcut,
                    [this] { m_playback->step(-1); });
    m_play = button(bar, "timelinePlay", tr("Play"), tr("Play or pause"), {Qt::Key_Space},
                    Qt::WindowShortcut, [this] { m_playback->setPlaying(!m_playback->playing()); });
    m_forward = button(bar, "timelineForward", tr("Frame forward"), tr("One frame forward"),
                       {Qt::Key_Period, Qt::Key_BracketRight}, Qt::WindowShortcut,
                       [this] { m_playback->step(1); });
    m_end = button(bar, "timelineEnd", tr("To the end"), tr("To the end"), {Qt::Key_End}, kHere,
                   [this] { m_playback->goTo(m_playback->bounds().endS); });
    auto* loop =
        button(bar, "timelineLoop", tr("Loop"),
               tr("Start again at the end, or at the end of the range"), {Qt::Key_L}, kHere, [] {});
    loop->defaultAction()->setCheckable(true);
    loop->defaultAction()->setChecked(true);
    connect(loop->defaultAction(), &QAction::toggled, m_playback, &Playback::setLoop);
    connect(m_playback, &Playback::playingChanged, this, [this] { updatePlay(); });
    updatePlay();
  }

  void addFrameBox(QHBoxLayout* bar) {
    bar->addWidget(new QLabel(tr("Frame"), this));
    m_frame = new CountBox(this);
    m_frame->setObjectName(QStringLiteral("timelineFrame"));
    m_frame->setToolTip(tr("Go to a frame at the document's rate; frame 0 is at 0 s (G)"));
    connect(m_frame, qOverload<int>(&QSpinBox::valueChanged), this, [this](int frame) {
      if (!m_updating) m_playback->goTo(frame / m_workspace.document().experiment().fps);
    });
    bar->addWidget(m_frame);
    m_frameCount = new QLabel(this);
    bar->addWidget(m_frameCount);
    auto* go = new QAction(tr("Go to frame"), this);
    go->setObjectName(QStringLiteral("timelineGoToFrame"));
    go->setShortcut(Qt::Key_G);
    connect(go, &QAction::triggered, this, [this] {
      m_frame->setFocus();
      m_frame->selectAll();
    });
    addAction(go);
  }

  void addSpeed(QHBoxLayout* bar) {
    auto* label = new QLabel(tr("Speed"), this);
    auto* speed = new NumberBox(this);
    speed->setObjectName(QStringLiteral("timelineSpeed"));
    speed->setRange(0.1, 4.0);
    speed->setSingleStep(0.1);
    speed->setValue(1.0);
    speed->setSuffix(tr(" ×"));
    speed->setToolTip(tr("Speed of playing; 1 is real time (+ and − in this panel)"));
    label->setBuddy(speed);
    connect(speed, qOverload<double>(&QDoubleSpinBox::valueChanged), m_playback,
            &Playback::setSpeed);
    bar->addWidget(label);
    bar->addWidget(speed);
    const auto key = [&](const char* name, const QString& text, const QList<QKeySequence>& keys,
                         double factor) {
      auto* action = new QAction(text, this);
      action->setObjectName(QLatin1String(name));
      action->setShortcuts(keys);
      action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
      connect(action, &QAction::triggered, speed,
              [speed, factor] { speed->setValue(speed->value() * factor); });
      addAction(action);
    };
    key("timelineFaster", tr("Play faster"), {Qt::Key_Plus, Qt::Key_Equal}, 1.25);
    key("timelineSlower", tr("Play slower"), {Qt::Key_Minus}, 0.8);
  }

  void addTolerance(QHBoxLayout* bar) {
    auto* label = new QLabel(tr("Contact below"), this);
    m_tolerance = new NumberBox(this);
    m_tolerance->setObjectName(QStringLiteral("timelineTolerance"));
    m_tolerance->setRange(0.3, 200.0);
    m_tolerance->setDecimals(1);
    m_tolerance->setSingleStep(1.0);
    m_tolerance->setValue(m_workspace.view().contactToleranceCmS());
    m_tolerance->setSuffix(tr(" cm/s"));
    m_tolerance->setToolTip(
        tr("A foot rests while it is slower than this over the floor; the 3D "
           "view marks the same contacts"));
    label->setBuddy(m_tolerance);
    connect(m_tolerance, qOverload<double>(&QDoubleSpinBox::valueChanged), &m_workspace.view(),
            &View::setContactToleranceCmS);
    connect(&m_workspace.view(), &View::contactToleranceChanged, this, [this] {
      m_tolerance->display(m_workspace.view().contactToleranceCmS());
      updateRows();
    });
    bar->addWidget(label);
    bar->addWidget(m_tolerance);
  }

  void connectWorkspace() {
    m_rowsTimer.setSingleShot(true);
    m_rowsTimer.setInterval(0);
    connect(&m_rowsTimer, &QTimer::timeout, this, [this] { updateRows(); });
    const auto later = [this] {
      if (!m_rowsTimer.isActive()) m_rowsTimer.start();
    };
    connect(&m_workspace.motions(), &MotionGroups::changed, this, later);
    connect(&m_workspace.motions(), &MotionGroups::visibilityChanged, this, later);
    connect(&m_workspace.view(), &View::selectionChanged, this, later);
    connect(&m_workspace.document(), &Document::changed, this, later);
    connect(&m_workspace.view(), &View::timeChanged, this, [this] { updateTime(); });
    connect(&m_workspace.view(), &View::rangeChanged, this, [this] { updateTime(); });
  }

  void updatePlay() {
    const bool playing = m_playback->playing();
    m_play->defaultAction()->setText(playing ? tr("Pause") : tr("Play"));
    drawIcons();
  }

  void drawIcons() {
    const QColor ink = palette().color(QPalette::ButtonText);
    const auto draw = [&ink](QToolButton* button, Transport sign) {
      button->defaultAction()->setIcon(transportIcon(sign, ink));
    };
    draw(m_home, Transport::Start);
    draw(m_back, Transport::Back);
    draw(m_play, m_playback->playing() ? Transport::Pause : Transport::Play);
    draw(m_forward, Transport::Forward);
    draw(m_end, Transport::End);
  }

  void updateRows() {
    const std::vector<GaitRow> rows = m_gaitRows.rows(m_workspace.contactRule());
    const bool motions = m_workspace.motions().duration() > 0.0;
    m_gait->setHint(motions ? tr("No joints of contact were found: name the feet in the document.")
                            : tr("Motions that you open or sample play here."));
    m_gait->setRows(rows, m_gaitRows.leftOut());
    updateTime();
  }

  void updateTime() {
    const double fps = m_workspace.document().experiment().fps;
    const double seconds = m_workspace.motions().duration();
    const int last = static_cast<int>(std::floor(seconds * fps + 1e-6));
    m_updating = true;
    m_frame->setRange(0, last);
    m_frame->display(static_cast<int>(std::lround(m_workspace.view().time() * fps)));
    m_updating = false;
    m_frameCount->setText(tr("of %1").arg(last));
    QString text =
        tr("%1 of %2 s").arg(m_workspace.view().time(), 0, 'f', 2).arg(seconds, 0, 'f', 2);
    if (const auto& range = m_workspace.view().range())
      text += tr(" · range %1 to %2 s").arg(range->beginS, 0, 'f', 2).arg(range->endS, 0, 'f', 2);
    m_label->setText(text);
    m_clear->defaultAction()->setEnabled(m_workspace.view().range().has_value());
    m_play->defaultAction()->setEnabled(seconds > 0.0);
  }

  Workspace& m_workspace;
  GaitRows m_gaitRows;
  Playback* m_playback;
  TimeRuler* m_ruler = nullptr;
  GaitView* m_gait = nullptr;
  QToolButton *m_home = nullptr, *m_back = nullptr, *m_play = nullptr, *m_forward = nullptr,
              *m_end = nullptr, *m_clear = nullptr;
  QLabel *m_label = nullptr, *m_frameCount = nullptr;
  CountBox* m_frame = nullptr;
  NumberBox* m_tolerance = nullptr;
  QTimer m_rowsTimer;
  bool m_updating = false;
};

}  // namespace

QWidget* makeTimelinePanel(Workspace& workspace, QWidget* parent) {
  return new TimelinePanel(workspace, parent);
}

}  // namespace marey::gui

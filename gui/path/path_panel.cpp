#include "gui/path/path_panel.h"

#include <QAction>
#include <QLabel>
#include <QScrollArea>
#include <QSplitter>
#include <QVBoxLayout>
#include <numbers>

#include "gui/path/natural_pace.h"
#include "gui/path/pace_plot.h"
#include "gui/path/path_list.h"
#include "gui/path/path_view.h"
#include "gui/path/way_point_form.h"
#include "gui/plots/workspace_chart.h"

namespace marey::gui {
namespace {

constexpr int kLeastPlotHeight = 96;
constexpr int kRoomForBar = 16;

class PathPanel : public QWidget {
 public:
  PathPanel(Workspace& workspace, QWidget* parent)
      : QWidget(parent),
        m_workspace(workspace),
        m_path(new CurrentPath(workspace, this)),
        m_natural(new NaturalPace(workspace, this)) {
    setObjectName(QStringLiteral("pathPanel"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
    layout->setSpacing(kSpacing);
    layout->addWidget(new PathList(workspace, *m_path, this));
    m_problem = new QLabel(this);
    m_problem->setObjectName(QStringLiteral("pathProblem"));
    m_problem->setWordWrap(true);
    layout->addWidget(m_problem);
    m_view = new PathView(workspace, *m_path, this);
    // Side by side: docks are wide rather than high.
    auto* splitter = new QSplitter(Qt::Horizontal, this);
    splitter->setChildrenCollapsible(false);
    splitter->addWidget(m_view);
    splitter->addWidget(buildNumbers());
    splitter->setStretchFactor(0, 1);
    layout->addWidget(splitter, 1);
    addKeys();
    connect(m_path, &CurrentPath::changed, this, [this] { refresh(); });
    connect(m_natural, &NaturalPace::changed, this, [this] { refresh(); });
    connect(&workspace.view(), &View::timeChanged, this, [this] { refreshTime(); });
    refresh();
  }

 protected:
  void changeEvent(QEvent* event) override {
    QWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange && m_problem) tintProblem();
  }

 private:
  /// The chosen way-point and the plots; a low dock scrolls them.
  QWidget* buildNumbers() {
    auto* lower = new QWidget(this);
    auto* layout = new QVBoxLayout(lower);
    layout->setContentsMargins(kSpacing, 0, 0, 0);
    layout->setSpacing(kSpacing);
    layout->addWidget(new WayPointForm(*m_path, *m_view, lower));
    m_speed = new PacePlot(QStringLiteral("pathSpeedPlot"), tr("Speed (m/s)"), 1.0, lower);
    m_turn = new PacePlot(QStringLiteral("pathTurnPlot"), tr("Turn rate (°/s)"),
                          180.0 / std::numbers::pi, lower);
    for (PacePlot* plot : {m_speed, m_turn})
      new ChartMenu(plot,
                    chartOutOf(m_workspace, plot->objectName(), [plot] { return plot->chart(); }));
    m_source = new QLabel(lower);
    m_source->setObjectName(QStringLiteral("pathRangeSource"));
    m_source->setWordWrap(true);
    layout->addWidget(m_source);
    layout->addWidget(m_speed, 1);
    layout->addWidget(m_turn, 1);
    for (PacePlot* plot : {m_speed, m_turn}) plot->setMinimumHeight(kLeastPlotHeight);
    auto* scroll = new QScrollArea(this);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setWidgetResizable(true);
    scroll->setWidget(lower);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    scroll->setMinimumWidth(lower->minimumSizeHint().width() + kRoomForBar);
    return scroll;
  }

  void addKeys() {
    const auto key = [this](const char* name, const QString& text, const QList<QKeySequence>& keys,
                            const std::function<void()>& run) {
      auto* action = new QAction(text, this);
      action->setObjectName(QLatin1String(name));
      action->setShortcuts(keys);
      action->setShortcutContext(Qt::WidgetShortcut);
      connect(action, &QAction::triggered, m_view, run);
      m_view->addAction(action);
    };
    key("pathRemoveWayPoint", tr("Remove way-point"), {Qt::Key_Delete, Qt::Key_Backspace},
        [this] { m_view->removeChosen(); });
    key("pathFit", tr("Fit path"), {Qt::Key_F, Qt::Key_X}, [this] { m_view->fit(); });
  }

  void tintProblem() {
    QPalette inks = m_problem->palette();
    const QColor wanted = inksOf(palette()).error;
    if (inks.color(QPalette::WindowText) == wanted) return;
    inks.setColor(QPalette::WindowText, wanted);
    m_problem->setPalette(inks);
  }

  void refresh() {
    const PathCurve& curve = m_path->curve();
    const auto& natural = m_natural->range();
    m_problem->setText(m_path->problem());
    m_problem->setVisible(!m_path->problem().isEmpty());
    tintProblem();
    m_view->setNatural(natural);
    m_speed->setValues(curve.speedMS, curve.fps);
    m_turn->setValues(curve.turnRadS, curve.fps);
    m_speed->setNatural(natural ? std::optional(natural->speedMS) : std::nullopt);
    m_turn->setNatural(natural ? std::optional(natural->turnRadS) : std::nullopt);
    m_source->setText(sourceText());
    m_source->setVisible(natural.has_value());
    refreshTime();
  }

  QString sourceText() const {
    const auto& natural = m_natural->range();
    if (!natural) return {};
    if (natural->model.empty())
      return tr("Bands: the document's natural motions (pale: all, darker: 5 to 95 %)");
    return tr("Bands: the training data of %1 (pale: 0.5 to 99.5 %, darker: 5 to 95 %)")
        .arg(QString::fromStdString(natural->model));
  }

  void refreshTime() {
    const double time = m_workspace.motions().duration() > 0.0 ? m_workspace.view().time() : -1.0;
    m_speed->setTime(time);
    m_turn->setTime(time);
  }

  Workspace& m_workspace;
  CurrentPath* m_path;
  NaturalPace* m_natural;
  PathView* m_view = nullptr;
  PacePlot *m_speed = nullptr, *m_turn = nullptr;
  QLabel *m_problem = nullptr, *m_source = nullptr;
};

}  // namespace

QWidget* makePathPanel(Workspace& workspace, QWidget* parent) {
  return new PathPanel(workspace, parent);
}

}  // namespace marey::gui

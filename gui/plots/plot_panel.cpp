#include "gui/plots/plot_panel.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QShowEvent>
#include <QStackedLayout>
#include <algorithm>
#include <utility>

#include "gui/plots/plot_recipe.h"

#include "base/error.h"

namespace marey::gui {
namespace {
constexpr int kDebounceMs = 120;
constexpr int kLeastChart = 90;  ///< pixels of a chart that are seen at once
}  // namespace

PlotPanel::PlotPanel(Workspace& workspace, const QString& name, bool overTime, QWidget* parent)
    : QWidget(parent), m_workspace(workspace), m_name(name), m_overTime(overTime) {
  auto* page = new QWidget(this);
  m_hint = new QLabel(page);
  m_hint->setObjectName(objectNameOf(QStringLiteral("Hint")));
  m_hint->setAlignment(Qt::AlignCenter);
  m_hint->setWordWrap(true);
  m_hint->setMargin(24);
  auto* shown = new QWidget(page);
  m_content = new QVBoxLayout(shown);
  m_content->setContentsMargins(0, 0, 0, 0);
  m_chart = new ChartView(shown);
  m_chart->setObjectName(objectNameOf(QStringLiteral("Chart")));
  m_chart->setFileStem(name);
  m_scroll = new QScrollArea(shown);
  m_scroll->setFrameShape(QFrame::NoFrame);
  m_scroll->setWidgetResizable(true);
  m_scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  m_scroll->setFocusPolicy(Qt::NoFocus);
  m_scroll->setMinimumHeight(kLeastChart);
  m_scroll->setWidget(m_chart);
  m_content->addWidget(m_scroll, 1);
  m_counted = new QLabel(this);
  m_counted->setObjectName(objectNameOf(QStringLiteral("Counted")));
  m_counted->setWordWrap(true);
  m_counted->setTextFormat(Qt::PlainText);
  m_counted->setTextInteractionFlags(Qt::TextSelectableByMouse);
  m_counted->hide();
  m_pages = new QStackedLayout(page);
  m_pages->addWidget(m_hint);
  m_pages->addWidget(shown);
  m_tools = new QHBoxLayout;
  m_tools->setContentsMargins(0, 0, 0, 0);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addLayout(m_tools);
  layout->addWidget(page, 1);
  layout->addWidget(m_counted);
  m_timer.setSingleShot(true);
  m_timer.setInterval(kDebounceMs);
  connect(&m_timer, &QTimer::timeout, this, [this] {
    m_stale = !isVisible();
    if (!m_stale) refresh();
  });
  for (const auto changed : {&MotionGroups::visibilityChanged, &MotionGroups::changed})
    connect(&workspace.motions(), changed, this, &PlotPanel::motionsMoved);
  connect(&workspace.jobs(), &JobQueue::ended, this, [this](int job) {
    if (job != m_job) return;
    m_job = 0;
    if (std::exchange(m_again, false)) refreshSoon();
  });
  connect(&workspace.view(), &View::selectionChanged, this, [this] { selectionMoved(); });
  connect(&workspace.view(), &View::rangeChanged, this, [this] { rangeMoved(); });
  m_chart->setNamer([this](const CurveRef& curve) {
    const auto found = m_curves.find(curve);
    if (found == m_curves.end() || found->second.size() != 1) return QString();
    const Motion* motion = m_workspace.motions().motion(found->second.front());
    return motion ? QString::fromStdString(motion->clip->name) : QString();
  });
  connect(m_chart, &ChartView::clicked, this, &PlotPanel::takeClick);
  connect(m_chart, &ChartView::saveFailed, this, [this](const QString& error) {
    m_workspace.report(tr("The chart was not saved"), error);
  });
  linkTime();
  followTime(overTime);
}

void PlotPanel::linkTime() {
  connect(&m_workspace.view(), &View::timeChanged, this, [this] { showTime(); });
  connect(&m_workspace.view(), &View::rangeChanged, this, [this] { showTime(); });
  connect(m_chart, &ChartView::brushed, this, [this](double low, double high) {
    m_workspace.view().setRange(TimeRange{low, high});
  });
  connect(m_chart, &ChartView::brushCleared, this, [this] {
    if (m_overTime) m_workspace.view().setRange(std::nullopt);
  });
}

void PlotPanel::followTime(bool overTime) {
  if (m_overTime != overTime) m_chart->resetZoom();
  m_overTime = overTime;
  m_chart->setTimeAxis(overTime);
  showTime();
}

void PlotPanel::showTime() {
  const auto& range = m_workspace.view().range();
  m_chart->setCursor(m_overTime ? std::optional(m_workspace.view().time()) : std::nullopt);
  m_chart->setRange(m_overTime && range ? std::optional(ChartSpan{range->beginS, range->endS})
                                        : std::nullopt);
}

void PlotPanel::refreshSoon() {
  m_stale = true;
  // Never started anew: changes that keep coming would put it off for ever.
  if (!m_timer.isActive()) m_timer.start();
}

void PlotPanel::motionsMoved() {
  const Experiment& e = m_workspace.document().experiment();
  Inputs now{.sets = motionSets(m_workspace.motions().groups(), comparison()),
             .systems = e.systems,
             .feet = e.feet,
             .toleranceStepCmS = e.toleranceStepCmS,
             .folder = e.folder};
  const auto same = [](const MotionSet& a, const MotionSet& b) {
    return a.ids == b.ids && a.clips == b.clips && a.name == b.name && a.system == b.system &&
           a.colour == b.colour && a.dashed == b.dashed;
  };
  if (now.systems == m_inputs.systems && now.feet == m_inputs.feet &&
      now.toleranceStepCmS == m_inputs.toleranceStepCmS && now.folder == m_inputs.folder &&
      std::equal(now.sets.begin(), now.sets.end(), m_inputs.sets.begin(), m_inputs.sets.end(),
                 same))
    return;
  m_inputs = std::move(now);
  // While motions are being added, a plot of the first ones is worth more than none.
  if (m_job != 0 && isVisible())
    m_again = true;
  else
    refreshSoon();
}

void PlotPanel::followComparison() {
  m_compares = true;
  connect(&m_workspace.view(), &View::comparisonChanged, this, &PlotPanel::refreshSoon);
}

Comparison PlotPanel::comparison() const {
  return m_compares ? m_workspace.view().comparison() : Comparison::ThisPath;
}

bool PlotPanel::nothingHeldOut(const std::vector<MotionSet>& sets) const {
  return comparison() == Comparison::HeldOut &&
         std::none_of(sets.begin(), sets.end(), [](const MotionSet& s) { return !s.natural; });
}

void PlotPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (m_stale && !m_timer.isActive()) m_timer.start();
}

void PlotPanel::showHint(const QString& sentence) {
  // What is still being worked out belongs to other motions.
  ++m_version;
  m_workspace.jobs().cancel(m_job);
  m_again = false;
  m_hint->setText(sentence);
  m_pages->setCurrentIndex(0);
}

void PlotPanel::showContent() {
  m_pages->setCurrentIndex(1);
}

QWidget* PlotPanel::chartArea() const {
  return m_scroll;
}

void PlotPanel::showCounted(const std::vector<MotionSet>& sets,
                            const std::vector<std::string>& notes) {
  std::string text = countedText(sets);
  for (const std::string& note : notes)
    if (!note.empty()) text += (text.empty() ? "" : ". ") + note;
  m_counted->setText(QString::fromStdString(text));
  m_counted->setVisible(!text.empty());
}

void PlotPanel::showGrid(LinkedGrid grid) {
  m_curves = std::move(grid.motions);
  m_chart->setRecipe(m_computed ? *m_computed : recipe());
  m_chart->setGrid(std::move(grid.grid));
  showHighlights();
  showContent();
}

void PlotPanel::showHighlights() {
  const std::set<MotionId>& selected = m_workspace.view().selection().motions;
  std::vector<ChartHighlight> highlights =
      selected.empty() ? std::vector<ChartHighlight>{} : curvesOf(selected);
  const size_t most = highlights.size() + kMostHighlights;
  for (const auto& [curve, motions] : m_curves) {
    const auto& charts = m_chart->grid().charts;
    const auto& series =
        charts[static_cast<size_t>(curve.chart)].series[static_cast<size_t>(curve.series)];
    const bool line = series.kind == render::SeriesKind::Line ||
                      series.kind == render::SeriesKind::Cloud ||
                      series.kind == render::SeriesKind::Density;
    const bool all = std::all_of(motions.begin(), motions.end(),
                                 [&](const MotionId& id) { return selected.contains(id); });
    if (!line || !all || highlights.size() >= most) continue;
    CurvePoints points = pointsOf(m_chart->grid(), curve);
    highlights.push_back({.chart = curve.chart,
                          .x = std::move(points.x),
                          .y = std::move(points.y),
                          .colour = series.colour});
  }
  m_chart->setHighlights(std::move(highlights));
}

void PlotPanel::takeClick(const ChartHit& hit, Qt::KeyboardModifiers modifiers) {
  const bool add = modifiers.testFlag(Qt::ControlModifier);
  if (hit.curve) {
    const auto found = m_curves.find(*hit.curve);
    if (found != m_curves.end()) {
      // Selecting shows highlights anew, but a slot may also replace the curves.
      const std::vector<MotionId> motions = found->second;
      selectMotions(motions, add);
    }
  }
  if (!m_overTime) return;
  double time = hit.x;
  if (hit.curve) {
    const auto& series = m_chart->grid().charts[static_cast<size_t>(hit.curve->chart)].series;
    const auto index = static_cast<size_t>(hit.curve->series);
    // A rule stands for one frame.
    if (index < series.size() && series[index].kind == render::SeriesKind::VerticalRule)
      time = series[index].x.front();
  }
  m_workspace.view().setTime(time);
}

void PlotPanel::selectMotions(const std::vector<MotionId>& motions, bool add) {
  Selection next = m_workspace.view().selection();
  if (!add) next.motions.clear();
  next.motions.insert(motions.begin(), motions.end());
  m_workspace.view().select(std::move(next));
}

render::Recipe PlotPanel::recipe() const {
  return plotRecipe(m_name.toStdString(), m_workspace.document().experiment(),
                    m_workspace.motions().groups(), m_workspace.view().range(), comparison());
}

void PlotPanel::run(const QString& title, Job::Work work, std::function<void()> take) {
  const int version = ++m_version;
  m_workspace.jobs().cancel(m_job);
  auto error = std::make_shared<QString>();
  const auto guarded = [error, work = std::move(work)](Progress& progress) {
    try {
      work(progress);
    } catch (const CancelledError&) {
      throw;
    } catch (const Error& fault) {
      *error = QString::fromStdString(fault.what());
    }
  };
  const QPointer<PlotPanel> self(this);
  m_job =
      m_workspace.jobs().start(Lane::Previews, title, guarded,
                               [self, version, error, input = recipe(), take = std::move(take)] {
                                 if (!self || self->m_version != version) return;
                                 if (!error->isEmpty()) return self->showHint(*error);
                                 self->m_computed = input;
                                 take();
                                 if (self) self->m_computed.reset();
                               });
}

}  // namespace marey::gui

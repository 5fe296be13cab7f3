// What panels with plots have in common: work in the background, an empty state, and the links of a
// chart to time, range and selection.
#pragma once

#include <QPointer>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>

#include "gui/plots/chart_view.h"
#include "gui/plots/linked_grid.h"
#include "gui/workspace/workspace.h"

class QHBoxLayout;
class QLabel;
class QScrollArea;
class QStackedLayout;
class QVBoxLayout;

namespace marey::gui {

class PlotPanel : public QWidget {
  Q_OBJECT
 public:
  /// `name` starts the object names: NAMEChart, NAMEHint. A chart over time follows time and range.
  PlotPanel(Workspace& workspace, const QString& name, bool overTime, QWidget* parent);

 protected:
  /// Works out again what is shown; called when the motions have changed and the panel is visible.
  virtual void refresh() = 0;
  virtual void selectionMoved() { showHighlights(); }
  /// The curves of picked motions that no curve of the chart is made of alone.
  virtual std::vector<ChartHighlight> curvesOf(const std::set<MotionId>& /*picked*/) const {
    return {};
  }
  virtual void rangeMoved() {}

  /// Soon after the first of many calls, and not while the panel is hidden.
  void refreshSoon();
  Workspace& workspace() const { return m_workspace; }
  ChartView* chart() const { return m_chart; }
  /// The chart and what scrolls it where it needs more height than there is.
  QWidget* chartArea() const;
  QHBoxLayout* tools() const { return m_tools; }
  /// Below the tools; the area of the chart is its first item.
  QVBoxLayout* content() const { return m_content; }
  QString objectNameOf(const QString& part) const { return m_name + part; }

  /// Whether x of the chart is time: then it shows and sets the time and the range.
  void followTime(bool overTime);
  /// One sentence in place of the content.
  void showHint(const QString& sentence);
  /// Shows a grid; its recipe names the motions that are visible now.
  void showGrid(LinkedGrid grid);
  void showContent();
  /// Below all: how many motions of every set are counted, and what is left out.
  void showCounted(const std::vector<MotionSet>& sets, const std::vector<std::string>& notes = {});
  void showHighlights();
  /// The recipe of what is shown: document, range, and of every set motions, model and seed.
  render::Recipe recipe() const;
  /// Motions of a curve, all of the set where it is a median or a band.
  void selectMotions(const std::vector<MotionId>& motions, bool add);

  /// Runs `work` beside the event loop and hands its result to `take`. A later call, or the end of
  /// the panel, makes an earlier one void. Errors of `work` are shown as the hint.
  template <typename Result>
  void compute(const QString& title, std::function<Result(Progress&)> work,
               std::function<void(Result&)> take) {
    auto result = std::make_shared<std::optional<Result>>();
    run(
        title, [result, work = std::move(work)](Progress& progress) { *result = work(progress); },
        [result, take = std::move(take)] { take(**result); });
  }

  /// From now on the panel compares along what the workspace says; others always along the path.
  void followComparison();
  Comparison comparison() const;
  /// Whether held-out control is asked for and no motion follows it.
  bool nothingHeldOut(const std::vector<MotionSet>& sets) const;
  bool computing() const { return m_job != 0; }

  void showEvent(QShowEvent* event) override;

 private:
  /// What plots are made from; equal inputs give equal plots.
  struct Inputs {
    std::vector<MotionSet> sets;
    std::vector<ExperimentSystem> systems;
    std::string feet;
    double toleranceStepCmS = 0.0;
    std::filesystem::path folder;
  };
  void motionsMoved();
  void run(const QString& title, Job::Work work, std::function<void()> take);
  void takeClick(const ChartHit& hit, Qt::KeyboardModifiers modifiers);
  void linkTime();
  void showTime();

  Workspace& m_workspace;
  QString m_name;
  QStackedLayout* m_pages = nullptr;
  QLabel *m_hint = nullptr, *m_counted = nullptr;
  QScrollArea* m_scroll = nullptr;
  QHBoxLayout* m_tools = nullptr;
  QVBoxLayout* m_content = nullptr;
  ChartView* m_chart = nullptr;
  std::map<CurveRef, std::vector<MotionId>> m_curves;
  QTimer m_timer;
  bool m_overTime = false;
  bool m_compares = false;
  bool m_stale = true;   ///< changed while hidden
  bool m_again = false;  ///< motions have changed while a plot of the earlier ones was worked out
  Inputs m_inputs;
  int m_version = 0;                         ///< of compute
  std::optional<render::Recipe> m_computed;  ///< while a result is taken: the recipe of its input
  int m_job = 0;                             ///< 0: nothing is worked out
};

}  // namespace marey::gui

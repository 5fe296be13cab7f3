#include "gui/shell/panels.h"

#include "gui/document/history_panel.h"
#include "gui/document/library_panel.h"
#include "gui/document/sampling_panel.h"
#include "gui/path/path_panel.h"
#include "gui/plots/distributions_panel.h"
#include "gui/plots/diversity_panel.h"
#include "gui/plots/footsteps_panel.h"
#include "gui/plots/likelihood_panel.h"
#include "gui/plots/statistics_panel.h"
#include "gui/scene/scene_panel.h"
#include "gui/steer/live_panel.h"
#include "gui/time/timeline_panel.h"
#include "gui/training/checkpoint_panel.h"

namespace marey::gui {

namespace {

QWidget* makeScene(const Desk& desk, QWidget* parent) {
  return makeScenePanel(desk.workspace, desk.scene, parent);
}

/// Of a panel that needs the workspace alone.
template <QWidget* (*make)(Workspace&, QWidget*)>
QWidget* of(const Desk& desk, QWidget* parent) {
  return make(desk.workspace, parent);
}

}  // namespace

const std::vector<PanelSpec>& panels() {
  static const std::vector<PanelSpec> all{
      {"scene", QObject::tr("Scene"), PanelArea::Centre, makeScene},
      {"library", QObject::tr("Motions"), PanelArea::Left, of<makeLibraryPanel>},
      {"history", QObject::tr("History"), PanelArea::Left, of<makeHistoryPanel>},
      {"sampling", QObject::tr("Sampling"), PanelArea::Right, of<makeSamplingPanel>},
      {"path", QObject::tr("Path"), PanelArea::Right, of<makePathPanel>},
      {"live", QObject::tr("Live"), PanelArea::Right, of<makeLivePanel>},
      {"checkpoints", QObject::tr("Checkpoints"), PanelArea::Right, of<makeCheckpointPanel>},
      {"likelihood", QObject::tr("Likelihood"), PanelArea::Plots, of<makeLikelihoodPanel>},
      {"footsteps", QObject::tr("Footsteps"), PanelArea::Plots, of<makeFootstepsPanel>},
      {"distributions", QObject::tr("Distributions"), PanelArea::Plots, of<makeDistributionsPanel>},
      {"diversity", QObject::tr("Diversity"), PanelArea::Plots, of<makeDiversityPanel>},
      {"statistics", QObject::tr("Statistics"), PanelArea::Plots, of<makeStatisticsPanel>},
      {"timeline", QObject::tr("Timeline"), PanelArea::Bottom, of<makeTimelinePanel>},
  };
  return all;
}

}  // namespace marey::gui

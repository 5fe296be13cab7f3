#include "panels/panels.h"

#include "panels/checkpoint_panel.h"
#include "panels/distributions_panel.h"
#include "panels/diversity_panel.h"
#include "panels/footsteps_panel.h"
#include "panels/history_panel.h"
#include "panels/library_panel.h"
#include "panels/likelihood_panel.h"
#include "panels/live_panel.h"
#include "panels/path_panel.h"
#include "panels/sampling_panel.h"
#include "panels/scene_panel.h"
#include "panels/statistics_panel.h"
#include "panels/timeline_panel.h"

namespace marey::gui {

const std::vector<PanelSpec>& panels() {
  static const std::vector<PanelSpec> all{
      {"scene", QObject::tr("Scene"), PanelArea::Centre, makeScenePanel},
      {"library", QObject::tr("Motions"), PanelArea::Left, makeLibraryPanel},
      {"history", QObject::tr("History"), PanelArea::Left, makeHistoryPanel},
      {"sampling", QObject::tr("Sampling"), PanelArea::Right, makeSamplingPanel},
      {"path", QObject::tr("Path"), PanelArea::Right, makePathPanel},
      {"live", QObject::tr("Live"), PanelArea::Right, makeLivePanel},
      {"checkpoints", QObject::tr("Checkpoints"), PanelArea::Right, makeCheckpointPanel},
      {"likelihood", QObject::tr("Likelihood"), PanelArea::Plots, makeLikelihoodPanel},
      {"footsteps", QObject::tr("Footsteps"), PanelArea::Plots, makeFootstepsPanel},
      {"distributions", QObject::tr("Distributions"), PanelArea::Plots, makeDistributionsPanel},
      {"diversity", QObject::tr("Diversity"), PanelArea::Plots, makeDiversityPanel},
      {"statistics", QObject::tr("Statistics"), PanelArea::Plots, makeStatisticsPanel},
      {"timeline", QObject::tr("Timeline"), PanelArea::Bottom, makeTimelinePanel},
  };
  return all;
}

}  // namespace marey::gui

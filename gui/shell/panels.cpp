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

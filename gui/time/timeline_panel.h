// One clock for all views: playing, scrubbing, the range, and the rhythm of the feet.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeTimelinePanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

// The checkpoints of a training run beside its loss, and what each of them moves like.
#pragma once

#include "gui/workspace/workspace.h"

namespace marey::gui {

QWidget* makeCheckpointPanel(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

// What belongs to the document as a whole: title, notes, rate, feet, how samples are judged.
#pragma once

#include "gui/workspace/workspace.h"

class QWidget;

namespace marey::gui {

/// Modal; OK makes one edit of all changes.
void showDocumentSettings(Workspace& workspace, QWidget* parent);

}  // namespace marey::gui

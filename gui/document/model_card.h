// What a model is: its card, parameters, and what its makers advise.
#pragma once

#include "gui/workspace/workspace.h"

#include "model/model_card.h"

class QWidget;

namespace marey::gui {

/// Markdown for people.
QString modelCardText(const ModelInfo& info, const ModelAdvice& advice, const std::string& file);
/// Shows it in a window of its own once the model is read; errors are reported.
void showModelCard(Workspace& workspace, size_t system, QWidget* parent);

}  // namespace marey::gui

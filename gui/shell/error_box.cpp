#include "gui/shell/error_box.h"

namespace marey::gui {

ErrorBox::ErrorBox(QWidget* parent)
    : QMessageBox(QMessageBox::Warning, tr("Marey"), {}, QMessageBox::Ok, parent) {
  setObjectName(QStringLiteral("errorBox"));
  // Not modal: work goes on, and several errors do not queue up behind each other.
  setModal(false);
  setTextInteractionFlags(Qt::TextSelectableByMouse);
}

void ErrorBox::tell(const QString& title, const QString& error) {
  // What is still being read is not taken away.
  const bool first = !isVisible();
  setText(first ? tr("%1 did not work.").arg(title) : tr("Several things did not work."));
  setInformativeText(first ? error
                           : informativeText() + QStringLiteral("\n\n") + title +
                                 QStringLiteral(": ") + error);
  show();
}

}  // namespace marey::gui

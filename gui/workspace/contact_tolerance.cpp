#include "gui/workspace/contact_tolerance.h"

namespace marey::gui {

ContactTolerance::ContactTolerance(Workspace& workspace)
    : QObject(&workspace), m_workspace(workspace) {}

ContactTolerance& ContactTolerance::of(Workspace& workspace) {
  auto* known = workspace.findChild<ContactTolerance*>(QString(), Qt::FindDirectChildrenOnly);
  return known ? *known : *new ContactTolerance(workspace);
}

void ContactTolerance::set(double cmS) {
  if (cmS == m_cmS) return;
  m_cmS = cmS;
  Q_EMIT changed();
}

stats::ContactRule ContactTolerance::rule() const {
  return {.toleranceCmS = m_cmS, .feet = m_workspace.experiment().feet};
}

}  // namespace marey::gui

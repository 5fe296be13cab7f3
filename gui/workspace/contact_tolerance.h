// The one speed below which a foot counts as resting, for the timeline and the 3D view alike.
#pragma once

#include <QObject>

#include "gui/workspace/workspace.h"

#include "stats/footsteps.h"

namespace marey::gui {

class ContactTolerance : public QObject {
  Q_OBJECT
 public:
  /// That of a workspace, which owns it.
  static ContactTolerance& of(Workspace& workspace);

  double cmS() const { return m_cmS; }
  void set(double cmS);
  /// With the feet of the document.
  stats::ContactRule rule() const;

 Q_SIGNALS:
  void changed();

 private:
  explicit ContactTolerance(Workspace& workspace);

  Workspace& m_workspace;
  double m_cmS = stats::ContactRule{}.toleranceCmS;
};

}  // namespace marey::gui

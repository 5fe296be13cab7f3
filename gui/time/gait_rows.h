// Which feet are shown over time, and when they rest: the rows of a gait diagram.
#pragma once

#include <QColor>
#include <QString>
#include <map>
#include <memory>
#include <vector>

#include "gui/workspace/workspace.h"

#include "render/base/colours.h"
#include "stats/footsteps.h"

namespace marey::gui {

struct GaitRow {
  QString motion;  ///< only at a motion's first foot
  QString foot;
  render::Colour colour;
  std::vector<TimeRange> contacts;
  double seconds = 0.0;  ///< of the motion
  bool first = false;    ///< of its motion
};

/// Contacts are worked out once per clip and rule, and kept while the clip is shown.
class GaitRows {
 public:
  explicit GaitRows(const Workspace& workspace) : m_workspace(workspace) {}
  /// Of the selected motions that are visible, or of the first visible one of every group.
  std::vector<GaitRow> rows(const stats::ContactRule& rule);
  /// Motions that the last call left out, because they are too many to tell apart.
  int leftOut() const { return m_leftOut; }

 private:
  struct Entry {
    ClipPtr clip;  ///< kept, so that its address stays its own
    std::vector<int> feet;
    std::vector<stats::ContactInterval> contacts;
  };
  std::vector<MotionId> shownMotions() const;
  const Entry& entryOf(const ClipPtr& clip);

  const Workspace& m_workspace;
  std::map<const Clip*, Entry> m_entries;
  stats::ContactRule m_rule;  ///< of the entries
  int m_leftOut = 0;
};

}  // namespace marey::gui

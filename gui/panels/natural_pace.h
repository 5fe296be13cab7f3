// Speeds and turn rates of the natural motions, worked out in the background.
#pragma once

#include <QObject>
#include <optional>

#include "panels/path_curve.h"
#include "shell/workspace.h"

namespace marey::gui {

class NaturalPace : public QObject {
  Q_OBJECT
 public:
  explicit NaturalPace(Workspace& workspace, QObject* parent = nullptr);
  /// None while there are no natural motions or they are being measured.
  const std::optional<PaceRange>& range() const { return m_range; }

 Q_SIGNALS:
  void changed();

 private:
  void refresh();

  Workspace& m_workspace;
  std::vector<ClipPtr> m_clips;
  std::optional<PaceRange> m_range;
  int m_version = 0;
};

}  // namespace marey::gui

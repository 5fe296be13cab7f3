// Speeds and turn rates that a path is judged by, found in the background: those of the training
// data of the document's first model that knows them, else of the natural motions.
#pragma once

#include <QObject>
#include <optional>

#include "gui/workspace/workspace.h"

#include "experiment/path_curve.h"

namespace marey::gui {

class NaturalPace : public QObject {
  Q_OBJECT
 public:
  explicit NaturalPace(Workspace& workspace, QObject* parent = nullptr);
  /// None while there is neither, or they are being measured.
  const std::optional<PaceRange>& range() const { return m_range; }

 Q_SIGNALS:
  void changed();

 private:
  void refresh();

  /// A system with the file and the time of its model.
  struct Source {
    std::string name, file, stamp;
    bool operator==(const Source&) const = default;
  };
  std::vector<Source> models() const;
  std::vector<ClipPtr> naturalClips() const;

  Workspace& m_workspace;
  std::vector<Source> m_models;
  std::vector<ClipPtr> m_clips;
  std::optional<PaceRange> m_range;
  int m_version = 0;
};

}  // namespace marey::gui

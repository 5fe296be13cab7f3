// Colours of the shown motions by a value of every frame: worked out beside the event loop, once
// for the same motions and scores.
#pragma once

#include <QObject>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gui/plots/motion_colours.h"
#include "gui/workspace/workspace.h"

namespace marey::gui {

/// What one motion is coloured from.
struct ColourSource {
  ClipPtr clip;
  const ClipScore* score = nullptr;  ///< null: none
  bool operator==(const ColourSource&) const = default;
};

class MotionColouring : public QObject {
  Q_OBJECT
 public:
  explicit MotionColouring(Workspace& workspace, QObject* parent = nullptr);
  /// The colours known by now; where sources have changed, changed() tells when theirs are there.
  const MotionColours& of(const std::vector<ColourSource>& sources, ColourBy by, double modelFps);

 Q_SIGNALS:
  void changed();

 private:
  Workspace& m_workspace;
  std::vector<ColourSource> m_sources;  ///< clips are kept, so that their addresses stay their own
  ColourBy m_by = ColourBy::System;
  MotionColours m_colours;
  int m_version = 0, m_job = 0;
};

}  // namespace marey::gui

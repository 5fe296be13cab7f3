// A small picture for every checkpoint of a training: its first sample along the current path.
#pragma once

#include <QImage>
#include <QListWidget>
#include <map>

#include "gui/workspace/workspace.h"

#include "model/training_run.h"
#include "render/base/colours.h"

namespace marey::gui {

/// Pictures are drawn in the background as soon as a checkpoint has motions.
class CheckpointStrip : public QListWidget {
  Q_OBJECT
 public:
  explicit CheckpointStrip(Workspace& workspace, QWidget* parent = nullptr);
  void setRun(const TrainingRun& run);
  /// Whether the picture of a checkpoint has been drawn.
  bool drawn(int checkpoint) const;

 Q_SIGNALS:
  /// By a click, after its motions have been selected.
  void checkpointClicked(int index);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  struct Picture {
    ClipPtr clip;  ///< that it shows
    render::Colour colour;
    QImage image;  ///< null: it could not be drawn
  };
  const MotionGroup* motionsOf(const Checkpoint& checkpoint) const;
  bool current(const Checkpoint& checkpoint) const;
  void refresh();
  void drawMissing();
  void choose(int index);

  Workspace& m_workspace;
  TrainingRun m_run;
  std::map<std::string, Picture> m_pictures;  ///< by the checkpoint's file
  int m_job = -1;
};

}  // namespace marey::gui

// The playing clock: real time, so that a slow view drops frames and never slows the motion down.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include "gui/workspace/workspace.h"

namespace marey::gui {

class Playback : public QObject {
  Q_OBJECT
 public:
  explicit Playback(Workspace& workspace, QObject* parent = nullptr);

  bool playing() const { return m_tick.isActive(); }
  /// From the start again where the end has been reached. Nothing without motions.
  void setPlaying(bool playing);
  void setLoop(bool loop) { m_loop = loop; }
  void setSpeed(double factor);
  /// Stops, and goes to a frame at the document's rate so many away.
  void step(int frames);
  void goTo(double seconds);
  /// What is played: the range, or all.
  TimeRange bounds() const;

 Q_SIGNALS:
  void playingChanged(bool playing);

 private:
  void advance();
  void rebase();

  Workspace& m_workspace;
  QTimer m_tick;
  QElapsedTimer m_clock;
  double m_from = 0.0, m_speed = 1.0;
  bool m_loop = true, m_setting = false;
};

}  // namespace marey::gui

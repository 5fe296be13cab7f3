// Long work beside the event loop: the adapter from core jobs to Qt signals.
#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "base/job.h"

namespace marey::gui {

/// Jobs of one lane run one after the other, lanes side by side: models keep all cores busy, files
/// can be read meanwhile, what is written (which may take long and is not the window's to show)
/// holds neither up, and what somebody waits for to look at does not wait for a thousand others.
enum class Lane { Files, Models, Exports, Previews };

struct JobStatus {
  int id = 0;
  Lane lane = Lane::Models;
  QString title, message;
  double fraction = 0.0;
  bool waiting = true;   ///< for the lane's earlier jobs
  double seconds = 0.0;  ///< running so far
  /// Estimated from the rate so far; negative while unknown.
  double secondsLeft = -1.0;
};

/// Lives on the GUI thread; `work` runs on another one, `done` and all signals on the GUI thread.
class JobQueue : public QObject {
  Q_OBJECT
 public:
  explicit JobQueue(QObject* parent = nullptr);
  /// Asks running work to stop and waits for it.
  ~JobQueue() override;

  /// `done` is called after success only and, where a context is given, only while that lives.
  int start(Lane lane, const QString& title, Job::Work work, std::function<void()> done = {},
            const QObject* context = nullptr);
  void cancel(int id);
  /// Also drops the results of jobs that have just ended.
  void cancelLane(Lane lane);
  void cancelAll();
  /// Cancels everything and waits until the running work has ended.
  void stop();
  bool idle() const;
  std::vector<JobStatus> jobs() const;

 Q_SIGNALS:
  void changed();
  void ended(int id, bool successful);
  void failed(const QString& title, const QString& error);

 private:
  struct Entry;
  void advance();
  void startNext(Lane lane);
  void finish(size_t index);
  void cancelWhere(const std::function<bool(const Entry&)>& wanted);

  std::vector<std::unique_ptr<Entry>> m_entries;  ///< in the order of starting
  QTimer m_timer;
  int m_nextId = 1;
};

}  // namespace marey::gui

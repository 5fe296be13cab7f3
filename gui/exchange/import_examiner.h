// Finds the files of an import and has the doctor look at them, all in one job; findings come to
// the event loop a few at a time.
#pragma once

#include <QObject>
#include <QTimer>
#include <map>
#include <memory>
#include <vector>

#include "gui/common/jobs.h"

#include "experiment/import_files.h"

namespace marey::gui {

class ImportExaminer : public QObject {
  Q_OBJECT
 public:
  ImportExaminer(JobQueue& jobs, QObject* parent);
  /// Ends its jobs.
  ~ImportExaminer() override;

  /// Lists what is given and examines it.
  void start(const std::vector<std::string>& given);
  /// Looks at one file again, before those that still wait.
  void examine(size_t file, const std::string& path, const io::ReadOptions& options);
  /// Looks at all of them again.
  void examineAll(const std::vector<ImportFile>& files);
  void cancel();
  /// Whether findings are still to come.
  bool busy() const { return m_timer.isActive(); }

 Q_SIGNALS:
  void listed(const marey::ImportList& list);
  /// `file` is its number in the list. Only the last examination of a file is told.
  void examined(size_t file, const std::vector<marey::io::DoctorReport>& reports);
  /// No longer busy.
  void settled();
  /// What was given is no motion; JobQueue::failed tells why.
  void failed();

 private:
  struct Shared;
  struct Task {
    size_t file;
    int version;
    std::string path;
    io::ReadOptions options;
  };
  static void examineTasks(const std::vector<Task>& tasks, Shared& shared, Progress& progress);
  void run(Lane lane, const QString& title, Job::Work work);
  void take();
  int nextVersion(size_t file);

  JobQueue& m_jobs;
  std::shared_ptr<Shared> m_shared;
  std::vector<int> m_running;
  std::map<size_t, int> m_versions;  ///< the last examination of every file that was asked for
  int m_allJob = -1;
  QTimer m_timer;
};

}  // namespace marey::gui

#include "gui/exchange/import_examiner.h"

#include <QFileInfo>
#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>

namespace marey::gui {
namespace {
constexpr int kTakeMs = 30;
/// Findings that are taken over in one turn of the event loop.
constexpr size_t kAtOnce = 40;
}  // namespace

/// What the jobs hand over.
struct ImportExaminer::Shared {
  struct Found {
    size_t file;
    int version;
    std::vector<io::DoctorReport> reports;
  };
  std::mutex mutex;
  std::optional<ImportList> list;
  std::deque<Found> found;
};

ImportExaminer::ImportExaminer(JobQueue& jobs, QObject* parent)
    : QObject(parent), m_jobs(jobs), m_shared(std::make_shared<Shared>()) {
  m_timer.setInterval(kTakeMs);
  connect(&m_timer, &QTimer::timeout, this, &ImportExaminer::take);
  connect(&jobs, &JobQueue::ended, this, [this](int id, bool successful) {
    if (std::erase(m_running, id) == 0) return;
    take();
    if (id == m_allJob && !successful && m_versions.empty()) Q_EMIT failed();
  });
}

ImportExaminer::~ImportExaminer() {
  disconnect(&m_jobs, nullptr, this, nullptr);
  cancel();
}

void ImportExaminer::cancel() {
  for (const int id : std::vector<int>(m_running)) m_jobs.cancel(id);
  m_timer.stop();
}

void ImportExaminer::run(Lane lane, const QString& title, Job::Work work) {
  const int id = m_jobs.start(lane, title, std::move(work));
  m_running.push_back(id);
  if (lane == Lane::Files) m_allJob = id;
  m_timer.start();
}

int ImportExaminer::nextVersion(size_t file) {
  return ++m_versions[file];
}

void ImportExaminer::examineTasks(const std::vector<Task>& tasks, Shared& shared,
                                  Progress& progress) {
  for (size_t i = 0; i < tasks.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(tasks.size()), tasks[i].path);
    auto reports = io::examine(tasks[i].path, tasks[i].options);
    const std::lock_guard lock(shared.mutex);
    shared.found.push_back({tasks[i].file, tasks[i].version, std::move(reports)});
  }
}

void ImportExaminer::start(const std::vector<std::string>& given) {
  run(Lane::Files, tr("Examining motion files"), [given, shared = m_shared](Progress& progress) {
    const ImportList list = importFiles(given);
    {
      const std::lock_guard lock(shared->mutex);
      shared->list = list;
    }
    std::vector<Task> tasks;
    for (size_t i = 0; i < list.files.size(); ++i)
      if (!list.files[i].skipped) tasks.push_back({i, 1, list.files[i].path, {}});
    examineTasks(tasks, *shared, progress);
  });
}

void ImportExaminer::examine(size_t file, const std::string& path, const io::ReadOptions& options) {
  const std::vector<Task> task = {{file, nextVersion(file), path, options}};
  run(Lane::Previews, tr("Examining %1").arg(QFileInfo(QString::fromStdString(path)).fileName()),
      [task, shared = m_shared](Progress& progress) { examineTasks(task, *shared, progress); });
}

void ImportExaminer::examineAll(const std::vector<ImportFile>& files) {
  m_jobs.cancel(m_allJob);
  std::vector<Task> tasks;
  for (size_t i = 0; i < files.size(); ++i)
    if (!files[i].skipped) tasks.push_back({i, nextVersion(i), files[i].path, files[i].options});
  run(Lane::Files, tr("Examining motion files"),
      [tasks, shared = m_shared](Progress& progress) { examineTasks(tasks, *shared, progress); });
}

void ImportExaminer::take() {
  std::optional<ImportList> list;
  std::deque<Shared::Found> found;
  bool more = false;
  {
    const std::lock_guard lock(m_shared->mutex);
    list.swap(m_shared->list);
    auto& waiting = m_shared->found;
    const auto end =
        waiting.begin() + static_cast<std::ptrdiff_t>(std::min(kAtOnce, waiting.size()));
    std::move(waiting.begin(), end, std::back_inserter(found));
    waiting.erase(waiting.begin(), end);
    more = !waiting.empty();
  }
  if (list) {
    for (size_t i = 0; i < list->files.size(); ++i) m_versions[i] = 1;
    Q_EMIT listed(*list);
  }
  for (const Shared::Found& one : found)
    if (m_versions[one.file] == one.version) Q_EMIT examined(one.file, one.reports);
  if (!m_running.empty() || more || !m_timer.isActive()) return;
  m_timer.stop();
  Q_EMIT settled();
}

}  // namespace marey::gui

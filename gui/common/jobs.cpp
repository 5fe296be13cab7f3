#include "gui/common/jobs.h"

#include <QPointer>
#include <algorithm>
#include <chrono>

namespace marey::gui {
namespace {
using Clock = std::chrono::steady_clock;
constexpr int kPollMs = 40;
}  // namespace

struct JobQueue::Entry {
  int id = 0;
  Lane lane = Lane::Models;
  QString title;
  Job::Work work;
  std::function<void()> done;
  bool hasContext = false;
  QPointer<const QObject> context;
  std::unique_ptr<Job> job;  ///< null while waiting
  Clock::time_point begin;
};

JobQueue::JobQueue(QObject* parent) : QObject(parent) {
  m_timer.setInterval(kPollMs);
  connect(&m_timer, &QTimer::timeout, this, &JobQueue::advance);
}

JobQueue::~JobQueue() = default;

int JobQueue::start(Lane lane, const QString& title, Job::Work work, std::function<void()> done,
                    const QObject* context) {
  auto entry = std::make_unique<Entry>();
  entry->id = m_nextId++;
  entry->lane = lane;
  entry->title = title;
  entry->work = std::move(work);
  entry->done = std::move(done);
  entry->hasContext = context != nullptr;
  entry->context = context;
  const int id = entry->id;
  m_entries.push_back(std::move(entry));
  startNext(lane);
  m_timer.start();
  Q_EMIT changed();
  return id;
}

void JobQueue::startNext(Lane lane) {
  for (const auto& entry : m_entries) {
    if (entry->lane != lane) continue;
    if (!entry->job) {
      entry->begin = Clock::now();
      entry->job = std::make_unique<Job>(entry->work);
    }
    return;
  }
}

void JobQueue::cancel(int id) {
  const auto found = std::find_if(m_entries.begin(), m_entries.end(),
                                  [id](const auto& entry) { return entry->id == id; });
  if (found == m_entries.end()) return;
  if ((*found)->job) {
    (*found)->job->requestStop();
    return;
  }
  m_entries.erase(found);
  Q_EMIT ended(id, false);
  Q_EMIT changed();
}

void JobQueue::cancelLane(Lane lane) {
  for (const auto& entry : m_entries)
    if (entry->lane == lane) entry->done = {};
  cancelWhere([lane](const Entry& entry) { return entry.lane == lane; });
}

void JobQueue::cancelAll() {
  cancelWhere([](const Entry&) { return true; });
}

void JobQueue::cancelWhere(const std::function<bool(const Entry&)>& wanted) {
  std::vector<int> ids;
  for (const auto& entry : m_entries)
    if (wanted(*entry)) ids.push_back(entry->id);
  // Backwards, so that no waiting job starts in the place of a stopped one.
  for (auto id = ids.rbegin(); id != ids.rend(); ++id) cancel(*id);
}

void JobQueue::stop() {
  cancelAll();
  m_entries.clear();  // a job's end joins its thread
  Q_EMIT changed();
}

bool JobQueue::idle() const {
  return m_entries.empty();
}

std::vector<JobStatus> JobQueue::jobs() const {
  std::vector<JobStatus> out;
  for (const auto& entry : m_entries) {
    JobStatus status{.id = entry->id, .lane = entry->lane, .title = entry->title};
    if (entry->job) {
      const Job::Status running = entry->job->status();
      status.waiting = false;
      status.fraction = running.fraction;
      status.message = QString::fromStdString(running.message);
      status.seconds = std::chrono::duration<double>(Clock::now() - entry->begin).count();
      if (running.fraction > 0.02 && status.seconds > 0.5)
        status.secondsLeft = status.seconds * (1.0 - running.fraction) / running.fraction;
    }
    out.push_back(status);
  }
  return out;
}

void JobQueue::advance() {
  for (size_t i = 0; i < m_entries.size();) {
    const bool ended =
        m_entries[i]->job && m_entries[i]->job->status().state != Job::State::Running;
    if (ended)
      finish(i);
    else
      ++i;
  }
  if (m_entries.empty()) m_timer.stop();
  Q_EMIT changed();
}

void JobQueue::finish(size_t index) {
  const std::unique_ptr<Entry> entry = std::move(m_entries[index]);
  m_entries.erase(m_entries.begin() + static_cast<std::ptrdiff_t>(index));
  const Job::Status status = entry->job->status();
  startNext(entry->lane);
  const bool successful = status.state == Job::State::Done;
  const bool alive = !entry->hasContext || entry->context;
  if (successful && entry->done && alive) entry->done();
  Q_EMIT ended(entry->id, successful);
  if (status.state == Job::State::Failed)
    Q_EMIT failed(entry->title, QString::fromStdString(status.error));
}

}  // namespace marey::gui

#include "base/job.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace marey {

Progress::Progress(Listener listener, std::stop_token stop)
    : m_listener(std::move(listener)), m_stop(std::move(stop)) {}

void Progress::report(double fraction, std::string_view message) {
  const std::lock_guard lock(m_mutex);
  if (fraction > m_fraction) m_fraction = std::min(fraction, 1.0);  // false for NaN
  if (m_listener) m_listener(m_fraction, message);
}

void Progress::throwIfCancelled() const {
  if (cancelled()) throw CancelledError();
}

Progress Progress::part(double from, double to) {
  return Progress(
      [this, from, to](double fraction, std::string_view message) {
        report(from + (to - from) * fraction, message);
      },
      m_stop);
}

Job::Job(Work work)
    : m_thread(
          [this, work = std::move(work)](std::stop_token stop) { run(work, std::move(stop)); }) {}

void Job::run(const Work& work, std::stop_token stop) {
  State end = State::Done;
  std::string error;
  try {
    Progress progress(
        [this](double fraction, std::string_view message) {
          const std::lock_guard lock(m_mutex);
          m_status.fraction = fraction;
          if (!message.empty()) m_status.message = message;
        },
        std::move(stop));
    work(progress);
  } catch (const CancelledError&) {
    end = State::Cancelled;
  } catch (const std::exception& e) {
    end = State::Failed;
    error = e.what();
  } catch (...) {
    end = State::Failed;
    error = "an error of unknown kind";
  }
  const std::lock_guard lock(m_mutex);
  m_status.state = end;
  m_status.error = error;
  if (end == State::Done) m_status.fraction = 1.0;
}

void Job::wait() {
  if (m_thread.joinable()) m_thread.join();
}

Job::Status Job::status() const {
  const std::lock_guard lock(m_mutex);
  return m_status;
}

}  // namespace marey

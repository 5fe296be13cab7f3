#include "experiment/motion_writers.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace marey {

MotionWriters::MotionWriters(int threads, size_t waiting, Write write)
    : m_write(std::move(write)), m_limit(std::max<size_t>(1, waiting)) {
  for (int i = 0; i < std::max(1, threads); ++i)
    m_threads.emplace_back([this](const std::stop_token& stop) { work(stop); });
}

MotionWriters::~MotionWriters() {
  for (std::jthread& thread : m_threads) thread.request_stop();
}

void MotionWriters::work(const std::stop_token& stop) {
  std::unique_lock lock(m_mutex);
  while (m_changed.wait(lock, stop, [this] { return !m_waiting.empty() && !m_error; })) {
    const Motion motion = std::move(m_waiting.front());
    m_waiting.pop_front();
    ++m_busy;
    lock.unlock();
    std::exception_ptr error;
    try {
      m_write(motion.sequence, motion.sample);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    --m_busy;
    ++m_written;
    if (error && !m_error) m_error = error;
    m_changed.notify_all();
    if (stop.stop_requested()) return;
  }
}

void MotionWriters::waitUntil(const std::function<bool()>& ready,
                              const std::function<void()>& pulse) {
  std::unique_lock lock(m_mutex);
  while (!m_changed.wait_for(lock, std::chrono::milliseconds(50),
                             [&] { return m_error || ready(); })) {
    lock.unlock();
    pulse();
    lock.lock();
  }
  if (m_error) std::rethrow_exception(m_error);
}

void MotionWriters::push(FeatureSequence motion, int sample, const std::function<void()>& pulse) {
  waitUntil([this] { return m_waiting.size() < m_limit; }, pulse);
  const std::lock_guard lock(m_mutex);
  m_waiting.push_back({std::move(motion), sample});
  m_changed.notify_all();
}

void MotionWriters::finish(const std::function<void()>& pulse) {
  waitUntil([this] { return m_waiting.empty() && m_busy == 0; }, pulse);
}

int MotionWriters::written() const {
  const std::lock_guard lock(m_mutex);
  return m_written;
}

}  // namespace marey

// Motions on their way from the sampler to files: fitting rotations and writing text takes longer
// than sampling, so threads of their own do it while the next motions are sampled.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "base/job.h"
#include "motion/features.h"

namespace marey {

class MotionWriters {
 public:
  /// Called on a thread of its own, for one motion.
  using Write = std::function<void(const FeatureSequence& motion, int sample)>;

  /// `threads` write at once; at most `waiting` motions wait, which bounds the memory.
  MotionWriters(int threads, size_t waiting, Write write);
  /// Drops what waits.
  ~MotionWriters();

  /// Waits while too many wait; `pulse` is called now and then meanwhile and may throw. Throws what
  /// `write` threw.
  void push(FeatureSequence motion, int sample, const std::function<void()>& pulse);
  /// Waits until all are written.
  void finish(const std::function<void()>& pulse);
  /// Motions written so far.
  int written() const;

 private:
  void work(const std::stop_token& stop);
  void waitUntil(const std::function<bool()>& ready, const std::function<void()>& pulse);

  struct Motion {
    FeatureSequence sequence;
    int sample = 0;
  };

  Write m_write;
  size_t m_limit;
  mutable std::mutex m_mutex;
  std::condition_variable_any m_changed;
  std::deque<Motion> m_waiting;
  size_t m_busy = 0;
  int m_written = 0;
  std::exception_ptr m_error;
  std::vector<std::jthread> m_threads;  // last: they use the members above
};

}  // namespace marey

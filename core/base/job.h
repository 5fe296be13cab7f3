// Long work: a stop token, monotone progress with a message, and the error text kept.
// Knows no user interface: the command line shows a bar, a window adapts it to signals.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace marey {

/// Handed to long-running functions, which report and ask whether to stop.
class Progress {
 public:
  /// fraction in [0, 1], never falling; message for people.
  using Listener = std::function<void(double fraction, std::string_view message)>;

  Progress() = default;
  explicit Progress(Listener listener, std::stop_token stop = {});

  /// Thread-safe; fractions lower than an earlier one are raised to it.
  void report(double fraction, std::string_view message = {});
  bool cancelled() const { return m_stop.stop_requested(); }
  /// Throws CancelledError when a stop was requested.
  void throwIfCancelled() const;
  /// A part of this progress: its 0..1 is mapped to [from, to] of this one.
  Progress part(double from, double to);

 private:
  Listener m_listener;
  std::stop_token m_stop;
  std::mutex m_mutex;
  double m_fraction = 0.0;

 public:
  Progress(Progress&& other) noexcept
      : m_listener(std::move(other.m_listener)),
        m_stop(std::move(other.m_stop)),
        m_fraction(other.m_fraction) {}
};

/// One function running on its own thread. The destructor requests a stop and joins.
class Job {
 public:
  enum class State { Running, Done, Failed, Cancelled };
  struct Status {
    State state = State::Running;
    double fraction = 0.0;
    std::string message;
    std::string error;  ///< text of the exception when Failed
  };
  using Work = std::function<void(Progress&)>;

  explicit Job(Work work);
  void requestStop() { m_thread.request_stop(); }
  /// Blocks until the work has ended.
  void wait();
  Status status() const;

 private:
  void run(const Work& work, std::stop_token stop);

  mutable std::mutex m_mutex;
  Status m_status;
  std::jthread m_thread;  // last: starts after the members it uses
};

}  // namespace marey

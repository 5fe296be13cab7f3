// Threads that work on one thing together: libtorch's OpenMP pool, so that no second pool fights
// it. No OpenMP or libtorch type appears here.
#pragma once

#include <algorithm>
#include <atomic>
#include <utility>

namespace marey::nn {

/// A member's view of its team.
class Team {
 public:
  /// How much of what was divided so far is taken up, and how much is done.
  struct Shared {
    alignas(64) std::atomic<long> taken = 0;
    alignas(64) std::atomic<long> done = 0;
  };
  /// A team of one.
  Team() = default;
  Team(int rank, int size, Shared& shared) : m_rank(rank), m_size(size), m_shared(&shared) {}

  int rank() const { return m_rank; }
  int size() const { return m_size; }
  /// This member's part of 0 .. count - 1: [first, second).
  std::pair<long, long> share(long count) const {
    return {count * m_rank / m_size, count * (m_rank + 1) / m_size};
  }

  /// Calls work([first, second)) for parts of 0 .. count - 1 and returns when all of them are done.
  /// Every member calls it equally often with the same counts. Parts go to whoever is free, so that
  /// a member that the system has suspended, on a machine that others use too, holds up the team
  /// only where it is in the midst of a part.
  template <typename Work>
  void divide(long count, const Work& work) {
    if (m_size == 1) {
      work(std::pair<long, long>{0, count});
      return;
    }
    const long begin = m_before, end = begin + count,
               together = std::max(1L, count / (kPartsEach * m_size));
    m_before = end;
    for (long at = m_shared->taken.load(); at < end;) {
      const long until = std::min(at + together, end);
      if (!m_shared->taken.compare_exchange_weak(at, until)) continue;
      work(std::pair{at - begin, until - begin});
      m_shared->done.fetch_add(until - at);
      at = m_shared->taken.load();
    }
    waitUntilDone(end);
  }

 private:
  static constexpr long kPartsEach = 16;
  void waitUntilDone(long end) const;

  int m_rank = 0, m_size = 1;
  Shared* m_shared = nullptr;
  long m_before = 0;  ///< divided in earlier calls
};

/// Threads that a team may have now: those asked for with --threads; one inside another team.
int teamThreads();

using TeamFunction = void (*)(const void* work, Team team);
void runTeam(int threads, TeamFunction function, const void* work);

/// Runs `work(Team)` on every member of a team of `threads` (or fewer, where the system gives
/// fewer). `work` must not throw.
template <typename Work>
void runTeam(int threads, const Work& work) {
  runTeam(
      threads, [](const void* w, Team team) { (*static_cast<const Work*>(w))(team); }, &work);
}

/// While it lives, what the calling thread starts runs on this thread alone.
class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int m_before;
};

}  // namespace marey::nn

// Threads that work on one thing together: libtorch's OpenMP pool, so that no second pool fights
// it. No OpenMP or libtorch type appears here.
#pragma once

#include <utility>

namespace marey::nn {

/// A member's view of its team.
struct Team {
  int rank = 0, size = 1;

  /// Until every member is here. Each member calls it equally often.
  void wait() const;
  /// This member's part of 0 .. count - 1: [first, second).
  std::pair<long, long> share(long count) const {
    return {count * rank / size, count * (rank + 1) / size};
  }
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

#include "nn/engine/team.h"

#include <thread>

#include <omp.h>

namespace marey::nn {

/// Looks at a number that another core is about to change, before the core is given to others.
constexpr int kLooks = 4000;

void Team::waitUntilDone(long end) const {
  for (int looks = 0; m_shared->done.load() < end; ++looks) {
    if (looks >= kLooks) std::this_thread::yield();
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
}

int teamThreads() {
  return omp_in_parallel() ? 1 : omp_get_max_threads();
}

void runTeam(int threads, TeamFunction function, const void* work) {
  if (threads <= 1) {
    function(work, Team{});
    return;
  }
  Team::Shared shared;
#pragma omp parallel num_threads(threads)
  function(work, Team(omp_get_thread_num(), omp_get_num_threads(), shared));
}

OneThread::OneThread() : m_before(omp_get_max_threads()) {
  omp_set_num_threads(1);
}

OneThread::~OneThread() {
  omp_set_num_threads(m_before);
}

}  // namespace marey::nn

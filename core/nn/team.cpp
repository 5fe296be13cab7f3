#include "nn/team.h"

#include <omp.h>

namespace marey::nn {

void Team::wait() const {
  if (size == 1) return;
#pragma omp barrier
}

int teamThreads() {
  return omp_in_parallel() ? 1 : omp_get_max_threads();
}

void runTeam(int threads, TeamFunction function, const void* work) {
  if (threads <= 1) {
    function(work, Team{});
    return;
  }
#pragma omp parallel num_threads(threads)
  function(work, Team{omp_get_thread_num(), omp_get_num_threads()});
}

OneThread::OneThread() : m_before(omp_get_max_threads()) {
  omp_set_num_threads(1);
}

OneThread::~OneThread() {
  omp_set_num_threads(m_before);
}

}  // namespace marey::nn

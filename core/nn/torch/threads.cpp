#include "nn/torch/threads.h"

#include <algorithm>
#include <cstdio>
#include <thread>

#include <dlfcn.h>
#include <fmt/format.h>

#include "nn/torch/torch.h"

namespace marey::nn {

void configureThreads(int threads, bool quiet) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  torch::set_num_threads(threads > 0 ? threads : std::max(1, cores));
  // 0 sequential, 1 pthreads, 2 OpenMP.
  using Ask = int (*)();
  using Set = void (*)(int);
  const auto ask = reinterpret_cast<Ask>(dlsym(RTLD_DEFAULT, "openblas_get_parallel"));
  const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (ask == nullptr || set == nullptr || ask() != 1) return;
  set(1);
  if (!quiet)
    fmt::print(stderr,
               "note: this OpenBLAS runs its own threads, which fight libtorch's: kept to one. "
               "On Debian, install libopenblas0-openmp and select it with update-alternatives.\n");
}

}  // namespace marey::nn

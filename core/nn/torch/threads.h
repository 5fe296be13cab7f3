// One pool of threads: libtorch's. No libtorch type appears here.
#pragma once

namespace marey::nn {

/// Sets libtorch's threads (0: one per core). Where OpenBLAS brings a thread pool of its own that
/// fights libtorch's (its pthread build), that pool is kept to one thread and stderr says so.
void configureThreads(int threads, bool quiet);

}  // namespace marey::nn

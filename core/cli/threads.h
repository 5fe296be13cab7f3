// One pool of threads: libtorch's. Internal to the command line.
#pragma once

namespace marey::cli {

/// Sets libtorch's threads (0: one per core). Where OpenBLAS brings a thread pool of its own that
/// fights libtorch's (its pthread build), that pool is kept to one thread and stderr says so.
void configureThreads(int threads, bool quiet);

}  // namespace marey::cli

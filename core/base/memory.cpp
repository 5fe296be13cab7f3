#include "base/memory.h"

#ifdef __unix__
#include <sys/resource.h>
#endif

namespace marey {

double peakMemoryMb() {
#ifdef __unix__
  rusage usage{};
  // Linux counts in units of 1024 bytes.
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<double>(usage.ru_maxrss) * 1.024e-3;
#endif
  return 0.0;
}

}  // namespace marey

// What this machine can do at most, measured: the yardsticks of the benchmarks.
#pragma once

#include <cstddef>

#include "nn/engine/packed_matrix.h"

namespace marey::nn {

/// Billions of floating-point operations per second of a large single-precision matrix product
/// through libtorch's BLAS, all threads.
double measureSgemm();

/// Billions of bytes per second that all threads together read from `bytes` of memory, again and
/// again: of the caches where they are few, of main memory where they are many.
class ReadSpeed {
 public:
  explicit ReadSpeed(size_t bytes);
  double measure() const;

 private:
  AlignedFloats m_values;
};

}  // namespace marey::nn

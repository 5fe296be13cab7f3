#include "nn/engine/kernels/lanes_avx512.h"
// The kernels are written over the lanes above.
#include "nn/engine/kernels/kernels_body.h"

namespace marey::nn {

extern const Kernels kAvx512Kernels;
const Kernels kAvx512Kernels = kernelsNamed("avx512");

}  // namespace marey::nn

#include "nn/engine/kernels/lanes_avx2.h"
// The kernels are written over the lanes above.
#include "nn/engine/kernels/kernels_body.h"

namespace marey::nn {

extern const Kernels kAvx2Kernels;
const Kernels kAvx2Kernels = kernelsNamed("avx2");

}  // namespace marey::nn

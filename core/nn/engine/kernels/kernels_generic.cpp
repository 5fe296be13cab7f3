#include "nn/engine/kernels/lanes_generic.h"
// The kernels are written over the lanes above.
#include "nn/engine/kernels/kernels_body.h"

namespace marey::nn {

extern const Kernels kGenericKernels;
const Kernels kGenericKernels = kernelsNamed("generic");

}  // namespace marey::nn

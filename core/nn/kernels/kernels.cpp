#include "nn/kernels/kernels.h"

#include <initializer_list>

namespace marey::nn {

extern const Kernels kGenericKernels;
#ifdef MAREY_X86_KERNELS
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

const Kernels* kernelsFor(Isa isa) {
#ifdef MAREY_X86_KERNELS
  if (isa == Isa::Avx512) return __builtin_cpu_supports("avx512f") ? &kAvx512Kernels : nullptr;
  if (isa == Isa::Avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &kAvx2Kernels
                                                                           : nullptr;
#endif
  return isa == Isa::Generic ? &kGenericKernels : nullptr;
}

const Kernels& kernels() {
  static const Kernels& best = [] {
    for (const Isa isa : {Isa::Avx512, Isa::Avx2})
      if (const Kernels* found = kernelsFor(isa)) return *found;
    return kGenericKernels;
  }();
  return best;
}

}  // namespace marey::nn

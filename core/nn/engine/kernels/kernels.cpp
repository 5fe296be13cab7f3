#include "nn/engine/kernels/kernels.h"

#include <array>
#include <cstdlib>
#include <string_view>

#include "base/error.h"

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

namespace {

constexpr std::array kBestFirst = {Isa::Avx512, Isa::Avx2, Isa::Generic};

const Kernels& kernelsOfName(std::string_view wanted) {
  std::string here;
  for (const Isa isa : kBestFirst) {
    const Kernels* found = kernelsFor(isa);
    if (found == nullptr) continue;
    if (found->name == wanted) return *found;
    here += (here.empty() ? "" : ", ") + std::string(found->name);
  }
  throw UsageError(fmt::format("MAREY_ISA: expected a kernel set of this machine ({}), found '{}'",
                               here, wanted));
}

const Kernels& chosenKernels() {
  if (const char* wanted = std::getenv("MAREY_ISA")) return kernelsOfName(wanted);
  for (const Isa isa : kBestFirst)
    if (const Kernels* found = kernelsFor(isa)) return *found;
  return kGenericKernels;
}

}  // namespace

const Kernels& kernels() {
  static const Kernels& chosen = chosenKernels();
  return chosen;
}

}  // namespace marey::nn

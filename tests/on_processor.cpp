// on_processor FEATURE COMMAND...: runs a test that needs a feature of the processor ("avx2",
// "avx512", or "any"); where there is none, says so and ends with the status that ctest takes for
// skipped.
#include <cstdio>
#include <string_view>

#include <unistd.h>

namespace {

constexpr int kSkipped = 77;

bool has(std::string_view feature) {
#if defined(__x86_64__)
  if (feature == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (feature == "avx512") return __builtin_cpu_supports("avx512f");
#endif
  return feature == "any";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: on_processor FEATURE COMMAND [ARGUMENT...]\n");
    return 2;
  }
  if (!has(argv[1])) {
    std::printf("skipped: this processor has no %s\n", argv[1]);
    return kSkipped;
  }
  ::execv(argv[2], argv + 2);
  std::perror(argv[2]);
  return 1;
}

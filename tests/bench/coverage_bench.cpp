// How often the intervals of distances hold the truth, for docs/statistics.md:
//   build/release/bin/bench_coverage [REPLICATIONS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "unit/stats/coverage.h"
#include <fmt/format.h>

int main(int argc, char** argv) {
  using namespace marey::stats;
  const int replications = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1000;
  fmt::print("| controls | paired | samples | shift | scale | Wasserstein % | KS % |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  struct Sets {
    int controls;
    bool paired;
    int samples;
  };
  for (const Sets& sets : {Sets{20, true, 1}, Sets{20, false, 1}, Sets{50, true, 1}})
    for (const auto& [shift, scale] :
         {std::pair{0.0, 1.0}, std::pair{0.2, 1.0}, std::pair{0.5, 1.0}, std::pair{1.0, 1.0},
          std::pair{1.5, 1.0}, std::pair{0.5, 1.5}}) {
      const CoverageCase c{.controls = sets.controls,
                           .paired = sets.paired,
                           .joints = 4,
                           .samples = sets.samples,
                           .frames = 5,
                           .shift = shift,
                           .scale = scale};
      const Coverage found = coverageOf(c, replications, 200, 1);
      fmt::print("| {} | {} | {} | {:g} | {:g} | {:.1f} | {:.1f} |\n", c.controls,
                 c.paired ? "yes" : "no", c.samples, shift, scale, 100.0 * found.wasserstein,
                 100.0 * found.kolmogorov);
      std::fflush(stdout);
    }
  return 0;
}

// Reading, features and footsteps of the walker's motion. Rates are per core.
#include <filesystem>

#include <benchmark/benchmark.h>

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "motion/features.h"
#include "motion/resample.h"
#include "motion/skeleton_fit.h"
#include "motion/walker.h"
#include "stats/footsteps.h"

namespace marey {
namespace {

const Clip& walk() {
  static const Clip clip = walkerDataSet(1, 120.0, 1).front().clip;
  return clip;
}

void readBvh(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "marey_bench.bvh";
  io::writeClip(walk(), path);
  const std::string bytes = readFile(path);
  std::filesystem::remove(path);
  std::filesystem::remove(path.string() + ".recipe.json");
  const auto& format = io::formatByName("bvh");
  for (auto _ : state) benchmark::DoNotOptimize(format.read(bytes, path, {}));
  state.SetBytesProcessed(static_cast<int64_t>(bytes.size()) * state.iterations());
}
BENCHMARK(readBvh)->Unit(benchmark::kMillisecond);

void features(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(extractFeatures(walk(), {}));
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(walk().frameCount()),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(features)->Unit(benchmark::kMillisecond);

/// Rotations of 60 s at 20 frames per second out of positions of which no skeleton is.
void fit(benchmark::State& state) {
  Clip clip = sliceFrames(resampled(walk(), 20.0), 0, 1200);
  clip.transforms.reset();
  for (size_t i = 0; i < clip.positions.size(); ++i)
    clip.positions[i].x() += 0.02f * static_cast<float>(i % 7) / 7.0f;
  for (auto _ : state) benchmark::DoNotOptimize(fitSkeleton(clip));
}
BENCHMARK(fit)->Unit(benchmark::kMillisecond);

void footsteps(benchmark::State& state) {
  const std::vector<Clip> clips(static_cast<size_t>(state.range(0)), walk());
  for (auto _ : state)
    benchmark::DoNotOptimize(
        stats::footstepCurve(clips, {.feet = stats::feetOf(*walk().skeleton)}));
}
BENCHMARK(footsteps)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey

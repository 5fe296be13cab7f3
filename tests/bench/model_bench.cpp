// Sampling and scoring with the shipped demo model, by batch size and by length.
#include "families.h"
#include <benchmark/benchmark.h>

#include "base/job.h"
#include "model/sampler.h"
#include "model/scorer.h"
#include "motion/walker.h"

namespace marey {
namespace {

const MotionModel& model() {
  static const auto loaded =
      loadModel(MAREY_SOURCE_DIR "/resources/demo/demo.marey", modelFamilies());
  return *loaded;
}

void sampleStill(benchmark::State& state) {
  constexpr size_t kFrames = 20;
  const SampleRequest request{.path = std::vector<RootFrame>(kFrames),
                              .samples = static_cast<int>(state.range(0)),
                              .warmUpS = 0.0};
  Progress progress;
  for (auto _ : state) benchmark::DoNotOptimize(sampleSequences(model(), request, progress));
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.range(0)) * kFrames,
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(sampleStill)->Arg(1)->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond)->UseRealTime();

void score(benchmark::State& state) {
  const Clip clip =
      walkerDataSet(1, static_cast<double>(state.range(0)), 1, model().info().features.fps)
          .front()
          .clip;
  for (auto _ : state) benchmark::DoNotOptimize(scoreClip(model(), clip, false));
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(clip.frameCount()),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(score)->Arg(10)->Arg(60)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace marey

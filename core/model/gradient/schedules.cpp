#include "model/gradient/schedules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace marey {
namespace {

double noam(const TrainingConfig& c, double t) {
  const auto warm = static_cast<double>(c.warmupSteps);
  return std::max(c.minimumRate, c.learningRate * std::sqrt(warm) *
                                     std::min(t * std::pow(warm, -1.5), 1.0 / std::sqrt(t)));
}

/// Up over the warm-up, then from the rate down to its minimum as `fall` goes from 1 to 0.
template <typename Fall>
double warmedUp(const TrainingConfig& c, double t, const Fall& fall) {
  const auto warm = static_cast<double>(c.warmupSteps);
  if (t < warm) return c.learningRate * t / warm;
  const double done =
      std::min(1.0, (t - warm) / std::max(1.0, static_cast<double>(c.steps) - warm));
  return c.minimumRate + (c.learningRate - c.minimumRate) * fall(done);
}

double stepwise(const TrainingConfig& c, int64_t step, int64_t windows) {
  const int64_t times = c.decayEverySteps > 0
                            ? step / c.decayEverySteps
                            : step * c.batch / std::max<int64_t>(1, windows) / c.decayEveryEpochs;
  return std::max(c.minimumRate,
                  c.learningRate * std::pow(c.decayFactor, static_cast<double>(times)));
}

}  // namespace

double learningRateAt(const TrainingConfig& c, int64_t step, int64_t windows) {
  const auto t = static_cast<double>(step + 1);
  if (c.schedule == "noam") return noam(c, t);
  if (c.schedule == "cosine")
    return warmedUp(c, t,
                    [](double done) { return 0.5 * (1.0 + std::cos(std::numbers::pi * done)); });
  if (c.schedule == "linear") return warmedUp(c, t, [](double done) { return 1.0 - done; });
  if (c.schedule == "step") return stepwise(c, step, windows);
  return c.learningRate;
}

double ownOutputShareAt(const ScheduledSampling& s, int64_t step) {
  const double done = std::clamp(
      static_cast<double>(step - s.beginStep) / static_cast<double>(s.endStep - s.beginStep), 0.0,
      1.0);
  return s.from + (s.to - s.from) * done;
}

}  // namespace marey

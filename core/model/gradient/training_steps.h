// The steps of a training run, one after the other. Internal (libtorch types).
#pragma once

#include <vector>

#include "model/gradient/gradient_step.h"
#include "model/gradient/run_setup.h"
#include "model/gradient/training_state.h"

namespace marey {

/// What happened since the last checkpoint.
struct Since {
  double loss = 0.0, norm = 0.0;  ///< sums over the steps taken
  std::vector<double> terms;
  int64_t taken = 0, skipped = 0;

  void add(const StepReport& step);
  int64_t steps() const { return taken + skipped; }
  /// Of a sum; NaN without a step.
  double mean(double sum) const;
};

class TrainingSteps {
 public:
  explicit TrainingSteps(RunSetup& setup);
  /// The step after those of `state`, whose batch and draws depend on the seed and its number
  /// alone. A step whose loss or gradient is not finite is skipped; the fifth in a row throws
  /// NumericError naming a layer.
  void takeOne(TrainingState& state);

  Optimiser& optimiser() const { return m_step.optimiser(); }
  const Since& since() const { return m_since; }
  void forget() { m_since = {}; }

 private:
  TrainingBatch batchOf(int64_t step);
  void skip(TrainingState& state);

  RunSetup& m_setup;
  GradientStep m_step;
  Since m_since;
};

}  // namespace marey

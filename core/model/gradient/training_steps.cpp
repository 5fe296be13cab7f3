#include "model/gradient/training_steps.h"

#include <cmath>

#include <ATen/CPUGeneratorImpl.h>

#include "base/error.h"
#include "model/gradient/input_noise.h"

namespace marey {
namespace {

constexpr int kNonFiniteLimit = 5;

/// The first parameter that (or whose gradient) is not finite; where all are, the loss alone
/// overflowed, and the parameter with the largest weight is the likely cause.
std::string suspectLayer(const torch::nn::Module& net) {
  std::string largestName;
  double largest = -1.0;
  for (const auto& item : net.named_parameters()) {
    const auto bad = [](const torch::Tensor& t) {
      return t.defined() && !t.isfinite().all().item<bool>();
    };
    if (bad(item.value())) return item.key() + " (its weights)";
    if (bad(item.value().grad())) return item.key() + " (its gradient)";
    const double size = item.value().abs().max().item<double>();
    if (size > largest) {
      largest = size;
      largestName = item.key();
    }
  }
  return fmt::format("{} (its largest weight is {:.3g})", largestName, largest);
}

}  // namespace

void Since::add(const StepReport& step) {
  loss += step.loss;
  norm += step.norm;
  terms.resize(step.terms.size(), 0.0);
  for (size_t i = 0; i < terms.size(); ++i) terms[i] += step.terms[i];
  ++taken;
}

double Since::mean(double sum) const {
  return taken > 0 ? sum / static_cast<double>(taken) : std::nan("");
}

TrainingSteps::TrainingSteps(RunSetup& setup)
    : m_setup(setup), m_step(setup.net(), setup.config, *setup.group) {}

TrainingBatch TrainingSteps::batchOf(int64_t step) {
  const uint64_t seed = m_setup.request.seed;
  auto generator =
      at::detail::createCPUGenerator(seed * 0x9E3779B97F4A7C15ull + static_cast<uint64_t>(step));
  auto out = m_setup.training.train.forStep(seed, step, m_setup.config.batch);
  out.step = step;
  out.draws = m_setup.net().draw(out, generator);
  out.noise = m_setup.training.noise.draw(out, generator);
  disturbInputs(m_setup.config, generator, out);
  return out;
}

void TrainingSteps::takeOne(TrainingState& state) {
  m_setup.net().train();
  const StepReport report =
      m_step.take(batchOf(state.step), m_setup.learningRateAt(state.step), state.updates + 1);
  if (report.taken) {
    state.nonFinite = 0;
    ++state.updates;
    addToAverage(m_setup.net(), m_setup.config.ema, state);
    m_since.add(report);
  } else {
    skip(state);
  }
  ++state.step;
}

void TrainingSteps::skip(TrainingState& state) {
  ++m_since.skipped;
  if (++state.nonFinite < kNonFiniteLimit) return;
  throw NumericError(fmt::format(
      "training: {} steps in a row gave a loss or gradient that is not finite; first bad layer: "
      "{}. The last checkpoint is kept; try a lower learning rate",
      kNonFiniteLimit, suspectLayer(m_setup.net())));
}

}  // namespace marey

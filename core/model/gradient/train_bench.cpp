#include "model/gradient/train_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <ATen/CPUGeneratorImpl.h>

#include "base/error.h"
#include "base/quantile.h"
#include "model/gradient/gradient_step.h"
#include "model/gradient/model_bench.h"
#include "model/gradient/weights.h"
#include "nn/torch/machine_limits.h"

namespace marey {
namespace {

constexpr int kStepsTogether = 2;  ///< of one path, before the other has its turn

double median(const std::vector<double>& values) {
  return values.empty() ? 0.0 : quantile(values, 0.5);
}

/// One path of one random model in training.
class TrainedPath {
 public:
  TrainedPath(const TrainBenchSpec& spec, const ModelFamily& family, Execution execution)
      : m_spec(spec),
        m_config(
            trainingConfigFromJson(spec.config.value("training", Json::object()), spec.origin)),
        m_group(nn::joinProcesses({}, {})) {
    const TensorFile file = randomModel(spec.config, spec.origin, family, spec.seed);
    const ModelInfo info = loadCommon(file, spec.origin);
    m_poseDim = info.poseDim;
    m_controlDim = info.controlDim;
    m_net = family
                .makeTrainee(spec.config, spec.origin,
                             {info.poseDim, info.controlDim, info.skeleton, info.standardiser},
                             spec.seed)
                .net;
    loadWeights(*m_net, file, spec.origin);
    m_net->execution = execution;
    m_net->train();
    m_step.emplace(*m_net, m_config, *m_group);
  }

  /// Milliseconds of the next step; the same batches on both paths.
  double step() {
    auto generator = at::detail::createCPUGenerator(m_spec.seed + static_cast<uint64_t>(m_steps));
    const int64_t window = m_net->context() + m_spec.frames + m_net->lookahead();
    TrainingBatch batch{torch::randn({m_spec.batch, window, m_poseDim}, generator),
                        torch::randn({m_spec.batch, window, m_controlDim}, generator),
                        torch::ones({m_spec.batch, window}),
                        {}};
    const auto begin = std::chrono::steady_clock::now();
    batch.draws = m_net->draw(batch, generator);
    loss = m_step->take(batch, m_config.learningRate, ++m_steps).loss;
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
  }
  int64_t parameters() const {
    int64_t out = 0;
    for (const auto& p : m_net->parameters()) out += p.numel();
    return out;
  }

  double loss = 0.0;  ///< of the last step

 private:
  const TrainBenchSpec& m_spec;
  TrainingConfig m_config;
  std::unique_ptr<nn::ProcessGroup> m_group;
  int64_t m_poseDim = 0, m_controlDim = 0;
  std::shared_ptr<TrainableModel> m_net;
  std::optional<GradientStep> m_step;
  int64_t m_steps = 0;
};

}  // namespace

TrainBenchResult benchTrain(const TrainBenchSpec& spec, const ModelFamily& family,
                            Progress& progress) {
  if (spec.batch < 1 || spec.frames < 1 || spec.steps < 1)
    throwInput({.path = "benchmark"}, "at least one window, frame and step", "{}, {} and {}",
               spec.batch, spec.frames, spec.steps);
  TrainedPath fast(spec, family, Execution::Engine);
  std::optional<TrainedPath> plain;
  if (spec.reference) plain.emplace(spec, family, Execution::Reference);
  TrainBenchResult out;
  // The first step pays for memory that later ones have.
  fast.step();
  out.lossNats = fast.loss;
  if (plain) {
    plain->step();
    out.maxDifference = std::abs(fast.loss - plain->loss);
  }
  std::vector<double> ms, plainMs, sgemm;
  for (int done = 0; done < spec.steps; done += kStepsTogether) {
    sgemm.push_back(nn::measureSgemm());
    const int count = std::min(kStepsTogether, spec.steps - done);
    for (int i = 0; i < count; ++i) {
      progress.throwIfCancelled();
      ms.push_back(fast.step());
    }
    for (int i = 0; plain && i < count; ++i) {
      progress.throwIfCancelled();
      plainMs.push_back(plain->step());
    }
    progress.report(static_cast<double>(done + count) / spec.steps, "training");
  }
  out.msPerStep = median(ms);
  out.bestMsPerStep = *std::min_element(ms.begin(), ms.end());
  if (plain) {
    out.referenceMsPerStep = median(plainMs);
    out.bestReferenceMsPerStep = *std::min_element(plainMs.begin(), plainMs.end());
  }
  out.parameters = fast.parameters();
  out.gflops =
      6e-6 * static_cast<double>(out.parameters) * spec.batch * spec.frames / out.msPerStep;
  out.sgemmGflops = median(sgemm);
  return out;
}

}  // namespace marey

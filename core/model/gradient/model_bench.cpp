#include "model/gradient/model_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/quantile.h"
#include "base/random.h"
#include "model/gradient/learnt.h"
#include "model/gradient/trainable.h"
#include "model/gradient/weights.h"
#include "motion/representation/representation.h"
#include "motion/walker.h"
#include "nn/torch/machine_limits.h"

namespace marey {
namespace {

constexpr int kRounds = 4;     ///< in each, both paths and the machine are measured
constexpr int kCompared = 50;  ///< frames; later ones differ by the chaos of long rollouts

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double median(const std::vector<double>& values) {
  return values.empty() ? 0.0 : quantile(values, 0.5);
}

Matrix normalMatrix(uint64_t seed, uint32_t sample, uint32_t frame, long rows, long columns) {
  Matrix out(rows, columns);
  fillNormal({.seed = seed, .sample = sample, .frame = frame, .stage = RandomStage::Test},
             {out.data(), static_cast<size_t>(out.size())});
  return out;
}

/// Both paths of one random model, and the machine's limits.
struct Bench {
  Bench(const ModelBenchSpec& spec, const ModelFamily& family)
      : fast(load(spec, family, {.weights = spec.weights})),
        reference(spec.reference ? load(spec, family, {.execution = Execution::Reference})
                                 : nullptr),
        bytes(static_cast<size_t>(fast->info().parameters) *
              (spec.weights == WeightPrecision::BFloat16 ? 2 : 4)),
        reading(bytes) {}

  static std::unique_ptr<MotionModel> load(const ModelBenchSpec& spec, const ModelFamily& family,
                                           const LoadOptions& options) {
    if (spec.batch < 1 || spec.frames < 1)
      throwInput({.path = "benchmark"}, "at least one motion and one frame", "{} and {}",
                 spec.batch, spec.frames);
    return family.load(randomModel(spec.config, spec.origin, family, spec.seed), spec.origin,
                       options);
  }

  void measureMachine() {
    sgemm.push_back(nn::measureSgemm());
    read.push_back(reading.measure());
  }

  ModelBenchResult result(const ModelBenchSpec& spec) const {
    ModelBenchResult out;
    out.parameters = fast->info().parameters;
    out.msPerFrame = median(ms);
    out.bestMsPerFrame = *std::min_element(ms.begin(), ms.end());
    out.referenceMsPerFrame = median(referenceMs);
    const size_t third = std::max<size_t>(1, ms.size() / 3);
    out.firstMsPerFrame = median({ms.begin(), ms.begin() + static_cast<long>(third)});
    out.lastMsPerFrame = median({ms.end() - static_cast<long>(third), ms.end()});
    out.maxDifference = difference;
    const double frames = 1000.0 / out.msPerFrame;
    out.gflops = 2e-9 * static_cast<double>(out.parameters) * spec.batch * frames;
    out.sgemmGflops = median(sgemm);
    out.weightGbPerS = 1e-9 * static_cast<double>(bytes) * frames;
    out.readGbPerS = median(read);
    return out;
  }

  std::unique_ptr<MotionModel> fast, reference;
  size_t bytes;
  nn::ReadSpeed reading;
  std::vector<double> ms, referenceMs, sgemm, read;
  double difference = 0.0;
};

/// One path's rollouts with random latents and control; the same for both paths.
class Sampling {
 public:
  Sampling(const MotionModel& model, const ModelBenchSpec& spec)
      : m_model(model),
        m_generator(requireRollout(model)),
        m_spec(spec),
        m_state(m_generator.start(spec.batch, {})) {}

  double frame(int t) {
    const ModelInfo& info = m_model.info();
    const auto at = static_cast<uint32_t>(t);
    const Matrix control =
                     normalMatrix(m_spec.seed, 0, at, m_spec.batch, info.controlWindowWidth()),
                 latent = normalMatrix(m_spec.seed, 1, at, m_spec.batch, info.latent.width);
    const auto begin = Clock::now();
    m_pose = m_generator.sampleFrame(m_state, control, latent);
    return msSince(begin);
  }
  const Matrix& pose() const { return m_pose; }

 private:
  const MotionModel& m_model;
  const FrameGenerator& m_generator;
  const ModelBenchSpec& m_spec;
  RolloutState m_state;
  Matrix m_pose;
};

/// Clips of noise.
struct Clips {
  Clips(const ModelInfo& info, const ModelBenchSpec& spec) {
    for (int b = 0; b < spec.batch; ++b) {
      const auto sample = static_cast<uint32_t>(b);
      poses.push_back(normalMatrix(spec.seed, sample, 0, spec.frames, info.poseDim));
      controls.push_back(normalMatrix(
          spec.seed, sample, 1, spec.frames + info.context + info.lookahead, info.controlDim));
    }
    for (size_t b = 0; b < poses.size(); ++b) observed.push_back({&poses[b], &controls[b]});
  }

  /// Milliseconds for all of them.
  double score(const MotionModel& model, Progress& progress,
               std::vector<SequenceScore>& out) const {
    const DensityEstimator& density = requireDensity(model);
    std::vector<RolloutState> states;
    for (size_t b = 0; b < poses.size(); ++b) states.push_back(density.start(1, {}));
    const auto begin = Clock::now();
    out = density.observeMany(states, observed, [&] { progress.throwIfCancelled(); });
    return msSince(begin);
  }

  std::vector<Matrix> poses, controls;
  std::vector<ObservedSequence> observed;
};

}  // namespace

TensorFile randomModel(const Json& config, const std::string& origin, const ModelFamily& family,
                       uint64_t seed) {
  ModelInfo info = family.describe(config, origin);
  const Representation& poses = representationOf(info.features, origin);
  const TraineeData data{
      info.poseDim,
      info.controlDim,
      info.poseDim == poses.width(*walkerSkeleton()) ? walkerSkeleton() : nullptr,
      {},
      info.features};
  if (!family.makeTrainee)
    throw InputError({.path = origin, .item = "key 'family'"}, "a family that is trained",
                     "'" + family.name + "'");
  const Trainee trainee = family.makeTrainee(config, origin, data, seed);
  info.config = trainee.config;
  info.skeleton = data.skeleton;
  TensorFile file;
  storeCommon(info, file);
  storeWeights(*trainee.net, file);
  const auto learnt = learntTensors(*trainee.net);
  uint32_t number = 0;
  for (auto& [name, tensor] : file.tensors) {
    auto values = tensor.toFloats();
    ++number;
    if (!learnt.contains(name) ||
        std::any_of(values.begin(), values.end(), [](float v) { return v != 0.f; }))
      continue;
    fillNormal({.seed = seed, .sample = number, .stage = RandomStage::Weights}, values);
    for (float& v : values) v *= 0.05f;
    tensor = Tensor::fromFloats(tensor.shape, values.data());
  }
  return file;
}

ModelBenchResult benchSample(const ModelBenchSpec& spec, const ModelFamily& family,
                             Progress& progress) {
  Bench bench(spec, family);
  Sampling fast(*bench.fast, spec);
  std::unique_ptr<Sampling> plain;
  if (bench.reference) plain = std::make_unique<Sampling>(*bench.reference, spec);
  // The first frames of each round find other data in the caches: they are not counted.
  constexpr int kUncounted = 2;
  const int each = (spec.frames + kRounds - 1) / kRounds + kUncounted;
  int t = 0;
  for (int round = 0; round < kRounds; ++round, t += each) {
    bench.measureMachine();
    std::vector<Matrix> poses;
    for (int i = 0; i < each; ++i) {
      progress.throwIfCancelled();
      const double ms = fast.frame(t + i);
      if (i >= kUncounted) bench.ms.push_back(ms);
      poses.push_back(fast.pose());
    }
    for (int i = 0; plain && i < each; ++i) {
      progress.throwIfCancelled();
      const double ms = plain->frame(t + i);
      if (i >= kUncounted) bench.referenceMs.push_back(ms);
      if (t + i < kCompared)
        bench.difference =
            std::max<double>(bench.difference,
                             (plain->pose() - poses[static_cast<size_t>(i)]).cwiseAbs().maxCoeff());
    }
    progress.report((round + 1.0) / kRounds, "sampling");
  }
  return bench.result(spec);
}

ModelBenchResult benchScore(const ModelBenchSpec& spec, const ModelFamily& family,
                            Progress& progress) {
  Bench bench(spec, family);
  const Clips clips(bench.fast->info(), spec);
  std::vector<SequenceScore> scores, plain;
  clips.score(*bench.fast, progress, scores);
  for (int round = 0; round < kRounds; ++round) {
    bench.measureMachine();
    bench.ms.push_back(clips.score(*bench.fast, progress, scores) / spec.frames);
    if (bench.reference)
      bench.referenceMs.push_back(clips.score(*bench.reference, progress, plain) / spec.frames);
    progress.report((round + 1.0) / kRounds, "scoring");
  }
  for (size_t b = 0; b < plain.size(); ++b)
    for (size_t t = 0; t < plain[b].loglikNats.size(); ++t)
      bench.difference =
          std::max(bench.difference, std::abs(plain[b].loglikNats[t] - scores[b].loglikNats[t]));
  return bench.result(spec);
}

}  // namespace marey

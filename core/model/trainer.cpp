#include "model/trainer.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include <ATen/CPUGeneratorImpl.h>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "model/batches.h"
#include "model/kept_checkpoints.h"
#include "model/likelihood.h"
#include "model/linear_gaussian.h"
#include "model/optimiser.h"
#include "model/run_files.h"
#include "model/training_noise.h"
#include "model/training_pace.h"
#include "model/training_state.h"
#include "model/weights.h"

namespace marey {
namespace fs = std::filesystem;
namespace {

constexpr int kNonFiniteLimit = 5;
constexpr int kEvaluationFrames = 400;
constexpr int64_t kEvaluationBatch = 16;
constexpr uint64_t kEvaluationSeed = 22;  ///< of the observation noise in evaluations
constexpr int kYardstickOrder = 3;

/// What the processes agree on before every step; the largest holds.
constexpr double kGoOn = 0.0, kEnd = 1.0, kCancel = 2.0;

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

/// Processes on one machine take its CUDA devices in turn.
torch::Device deviceOf(const TrainRequest& request) {
  if (request.device == "cpu") return torch::kCPU;
  if (request.device != "cuda")
    throw UsageError("--device: expected cpu or cuda, found '" + request.device + "'");
  if (!torch::cuda::is_available())
    throw UsageError("--device cuda: this libtorch sees no CUDA device");
  const auto count = static_cast<int>(torch::cuda::device_count());
  return {torch::kCUDA, static_cast<c10::DeviceIndex>(request.process.rank % count)};
}

/// One training run: what it is given, what it carries, what it writes.
class Run {
 public:
  Run(const DataSet& data, const TrainRequest& request, std::span<const ModelFamily> families)
      : m_data(data),
        m_request(request),
        m_family(familyNamed(request.config.value("family", ""), families, request.configOrigin)),
        m_config(trainingConfigFromJson(request.config.value("training", Json::object()),
                                        request.configOrigin)),
        m_device(deviceOf(request)),
        m_group(nn::joinProcesses(request.process,
                                  nn::meetingPoint(fs::weakly_canonical(request.run).string()))) {
    requireFinite(data.train, "training data");
    requireFinite(data.test, "test data");
    m_trainee = m_family.makeTrainee(
        request.config.at("model"), request.configOrigin,
        {data.poseDim(), data.controlDim(), data.skeleton, data.standardiser}, request.seed);
    makeBatches();
  }

  TrainResult execute(Progress& progress) {
    begin();
    const auto clock = std::chrono::steady_clock::now();
    const double before = m_state.seconds;
    const int64_t firstStep = m_state.step;
    double decision = kGoOn;
    while ((decision = m_group->largest(wish(progress))) == kGoOn) {
      trainStep();
      m_state.seconds =
          before + std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
      tell(progress,
           static_cast<double>(m_state.step - firstStep) / (m_state.seconds - before + 1e-9));
      if (m_state.step % m_config.checkpointEvery == 0) checkpoint();
    }
    const bool idle = m_state.step == firstStep;
    if (idle && m_request.resume)
      restate();
    else if (idle || m_sinceCheckpoint > 0)
      checkpoint();
    if (decision == kCancel) throw CancelledError();
    return {m_state.step,
            m_lastTrainBits,
            m_state.bestValid,
            m_lastTestNats,
            m_request.run / "best.marey",
            m_request.run / "last.marey"};
  }

  nn::ProcessGroup& group() { return *m_group; }

 private:
  void makeBatches() {
    const double fps = m_data.options.features.fps;
    const int window = static_cast<int>(std::lround(m_config.windowS * fps));
    const int hop = std::max(1, static_cast<int>(std::lround(m_config.hopS * fps)));
    const auto scored = window - m_trainee.net->context() - m_trainee.net->lookahead();
    if (scored < 1)
      throwInput({.path = m_request.configOrigin, .item = "key 'training.window_s'"},
                 fmt::format("windows longer than the model's context of {} frames",
                             m_trainee.net->context() + m_trainee.net->lookahead()),
                 "{} frames", window);
    auto [train, valid] = splitValidation(m_data.train, m_config.validationShare);
    if (!m_config.useReversed)
      std::erase_if(train, [](const FeatureSequence& s) { return s.name.ends_with("|reverse"); });
    m_pace = trainingPace(train, fps);
    m_noise.emplace(*m_trainee.net, m_data.standardiser, m_device);
    if (!m_noise->none())
      m_yardstick = std::make_shared<const LinearGaussian>(fitLinearGaussian(
          train, std::min<int>(kYardstickOrder, static_cast<int>(m_trainee.net->context())),
          m_noise->observation().floorM));
    m_train.emplace(train, m_data.standardiser, window, hop, m_device);
    const int context = static_cast<int>(m_trainee.net->context());
    const int longHop = kEvaluationFrames;
    if (!valid.empty())
      m_valid.emplace(valid, m_data.standardiser, kEvaluationFrames + context, longHop, m_device);
    if (!m_data.test.empty())
      m_test.emplace(m_data.test, m_data.standardiser, kEvaluationFrames + context, longHop,
                     m_device);
  }

  TrainingFrames trainingFrames() const {
    auto out = m_train->frames(m_trainee.net->context(), m_trainee.net->lookahead());
    out.noise = m_noise->deviation();
    return out;
  }

  Json identity() const {
    Json training = toJson(m_config);
    training.erase("steps");       // a run may be prolonged
    training.erase("accumulate");  // and go on where there is less memory
    training.erase("keep");        // or disk
    return {{"data", m_data.hash},
            {"seed", m_request.seed},
            {"training", training},
            {"model", m_trainee.config}};
  }

  void begin() {
    TrainableModel& net = *m_trainee.net;
    const fs::path statePath = m_request.run / "state.marey";
    const bool exists = fs::exists(statePath);
    if (m_request.resume && !exists)
      throw FileError(fmt::format("{}: nothing to resume", statePath.string()));
    if (!m_request.resume && exists)
      throw InputError({.path = m_request.run.string()}, "a new folder, or --resume", "a run");
    net.to(m_device);
    net.execution = m_request.execution;
    m_group->requireSame("run", identity().dump());
    m_optimiser.emplace(net, m_config, *m_group);
    if (m_request.resume) {
      m_state = loadState(statePath, net, m_optimiser->adam, identity());
      m_facts = readJson(m_request.run / "config.json").value("facts", Json::object());
      if (m_group->leads()) cutLog(m_request.run, m_state.step);
      return;
    }
    if (m_request.init.empty()) {
      m_facts = net.initialise(trainingFrames());
    } else {
      loadWeights(net, readTensorFile(m_request.init), m_request.init.string());
      m_facts = {{"initial_weights", m_request.init.filename().string()}};
    }
    // Another kind of processor may have rounded its start otherwise.
    for (auto& p : net.parameters()) m_group->spread(p);
    for (auto& b : net.buffers()) m_group->spread(b);
    if (m_config.ema > 0)
      for (const auto& item : net.named_parameters())
        m_state.average[item.key()] = item.value().detach().clone();
    if (!m_group->leads()) return;
    writeJson(m_request.run / "config.json", {{"config", m_request.config},
                                              {"seed", m_request.seed},
                                              {"facts", m_facts},
                                              {"data", m_data.hash}});
    startLog(m_request.run);
  }

  double wish(const Progress& progress) const {
    if (progress.cancelled()) return kCancel;
    if (m_state.step >= m_request.steps.value_or(m_config.steps)) return kEnd;
    // Clocks differ: that of the leading process counts.
    const bool late = m_request.minutes && m_state.seconds >= 60.0 * *m_request.minutes;
    return late && m_group->leads() ? kEnd : kGoOn;
  }

  void trainStep() {
    TrainableModel& net = *m_trainee.net;
    net.train();
    auto generator = at::detail::createCPUGenerator(m_request.seed * 0x9E3779B97F4A7C15ull +
                                                    static_cast<uint64_t>(m_state.step));
    auto batch = m_train->forStep(m_request.seed, m_state.step, m_config.batch);
    batch.keep = net.drawDropout(batch, generator);
    batch.noise = m_noise->draw(batch, generator);
    const StepReport report =
        m_optimiser->step(batch, learningRateAt(m_config, m_state.step), m_state.updates + 1);
    if (!report.taken) {
      skip(net);
    } else {
      m_state.nonFinite = 0;
      ++m_state.updates;
      updateAverage(net);
      m_lossSum += report.lossNats;
      m_normSum += report.norm;
      ++m_lossCount;
    }
    ++m_state.step;
    ++m_sinceCheckpoint;
  }

  void skip(const TrainableModel& net) {
    ++m_skipped;
    if (++m_state.nonFinite < kNonFiniteLimit) return;
    throw NumericError(fmt::format(
        "training: {} steps in a row gave a loss or gradient that is not finite; first bad layer: "
        "{}. The last checkpoint is kept; try a lower learning rate",
        kNonFiniteLimit, suspectLayer(net)));
  }

  void updateAverage(const TrainableModel& net) {
    const torch::NoGradGuard guard;
    // A short memory at first, so that the random start is forgotten.
    const double decay = std::min(m_config.ema, (1.0 + static_cast<double>(m_state.updates)) /
                                                    (10.0 + static_cast<double>(m_state.updates)));
    if (!m_state.average.empty())
      for (const auto& item : net.named_parameters())
        m_state.average[item.key()].lerp_(item.value(), 1.0 - decay);
  }

  /// Bits per frame of standardised poses; NaN without data. Every process takes some windows.
  double evaluate(const std::optional<Batches>& batches) {
    if (!batches) return std::nan("");
    const c10::InferenceMode guard;
    m_trainee.net->eval();
    double sum = 0.0, frames = 0.0;
    const auto [rank, size] = m_group->rank();
    for (int64_t first = rank * kEvaluationBatch; first < batches->windowCount();
         first += size * kEvaluationBatch) {
      auto batch =
          batches->inOrder(first, std::min(kEvaluationBatch, batches->windowCount() - first));
      auto generator =
          at::detail::createCPUGenerator(kEvaluationSeed + static_cast<uint64_t>(first));
      batch.noise = m_noise->draw(batch, generator);
      const double count = scoredFrames(*m_trainee.net, batch);
      if (count == 0.0) continue;
      sum += sumOfLogLikelihood(*m_trainee.net, batch).item<double>();
      frames += count;
    }
    auto both = torch::tensor({sum, frames}, torch::kFloat64);
    m_group->sum(both);
    sum = both[0].item<double>();
    frames = both[1].item<double>();
    return frames > 0.0 ? -sum / frames / std::numbers::ln2 : std::nan("");
  }

  /// Nats per frame of poses in centimetres, of bits per frame of standardised ones.
  double natsPerFrame(double bits) const {
    return -bits * std::numbers::ln2 + toCentimetresPerFrame(m_data.standardiser);
  }

  void checkpoint() {
    double valid = 0.0, test = 0.0;
    std::string model;
    {
      const AveragedWeights averaged(*m_trainee.net, m_state);
      valid = evaluate(m_valid);
      test = evaluate(m_test);
      if (m_group->leads()) model = serialise(exportModel(valid, test));
    }
    m_lastTrainBits = m_lossCount > 0 ? m_lossSum / m_lossCount / std::numbers::ln2 : std::nan("");
    m_lastTestNats = natsPerFrame(test);
    const double judged = std::isnan(valid) ? m_lastTrainBits : valid;
    const bool best = judged < m_state.bestValid;
    if (best) m_state.bestValid = judged;
    if (m_group->leads()) write(model, best, valid, test);
    m_lossSum = m_normSum = 0.0;
    m_lossCount = m_skipped = 0;
    m_sinceCheckpoint = 0;
  }

  void write(const std::string& model, bool best, double valid, double test) {
    writeFileAtomically(m_request.run / "last.marey", model);
    if (best) writeFileAtomically(m_request.run / "best.marey", model);
    const auto due = m_config.snapshotMinutes > 0
                         ? static_cast<int64_t>(m_state.seconds / 60.0 / m_config.snapshotMinutes)
                         : 0;
    if (due > m_state.snapshots) {
      m_state.snapshots = due;
      writeFileAtomically(
          m_request.run / "snapshots" / fmt::format("step_{:07}.marey", m_state.step), model);
    }
    keepCheckpoint(m_request.run, m_config, m_state.step, model);
    const double count = std::max<double>(1.0, static_cast<double>(m_lossCount));
    appendLog(m_request.run,
              {m_state.step, m_state.seconds, learningRateAt(m_config, m_state.step - 1),
               m_lastTrainBits, valid, test, m_normSum / count, m_skipped});
    // Last: a run that is killed before this line goes on from the checkpoint before.
    saveState(m_request.run / "state.marey", m_state, *m_trainee.net, m_optimiser->adam,
              identity());
  }

  /// A run that had ended says again what it reached.
  void restate() {
    const AveragedWeights averaged(*m_trainee.net, m_state);
    m_lastTrainBits = std::nan("");
    m_lastTestNats = natsPerFrame(evaluate(m_test));
  }

  TensorFile exportModel(double valid, double test) {
    ModelInfo info;
    info.observation = m_noise->observation();
    info.yardstick = m_yardstick;
    info.family = m_family.name;
    info.variant = m_request.config.value("name", m_family.name);
    info.poseDim = m_data.poseDim();
    info.controlDim = m_data.controlDim();
    info.config = m_trainee.config;
    info.features = m_data.options.features;
    info.skeleton = m_data.skeleton;
    info.standardiser = m_data.standardiser;
    info.provenance = {{"data", m_data.hash},
                       {"training_clips", m_data.train.size()},
                       {"seed", m_request.seed},
                       {"steps", m_state.step},
                       {"training_seconds", m_state.seconds},
                       {"training", toJson(m_config)},
                       {"facts", m_facts},
                       {"command", m_request.command}};
    if (!m_noise->none())
      info.provenance["floor_directions"] =
          m_noise->floorDirections(*m_trainee.net, trainingFrames());
    if (!std::isnan(valid)) info.provenance["valid_nats_per_frame"] = natsPerFrame(valid);
    if (!std::isnan(test)) info.provenance["test_nats_per_frame"] = natsPerFrame(test);
    info.provenance["likelihood_unit"] = kLikelihoodUnit;
    info.provenance["training_pace"] = toJson(m_pace);
    info.provenance["bone_lengths_m"] = m_data.boneLengthsM;
    TensorFile file;
    storeCommon(info, file);
    storeWeights(*m_trainee.net, file);
    return file;
  }

  void tell(Progress& progress, double rate) {
    const double bySteps = static_cast<double>(m_state.step) /
                           static_cast<double>(m_request.steps.value_or(m_config.steps));
    const double byTime = m_request.minutes ? m_state.seconds / (60.0 * *m_request.minutes) : 0.0;
    const double bits =
        m_lossCount > 0 ? m_lossSum / m_lossCount / std::numbers::ln2 : std::nan("");
    const auto valid = std::isfinite(m_state.bestValid)
                           ? fmt::format(" (valid {:.1f})", m_state.bestValid)
                           : std::string();
    progress.report(std::min(1.0, std::max(bySteps, byTime)),
                    fmt::format("step {}, {:.2f} steps/s, {:.1f} bits per frame{}", m_state.step,
                                rate, bits, valid));
  }

  const DataSet& m_data;
  const TrainRequest& m_request;
  const ModelFamily& m_family;
  TrainingConfig m_config;
  torch::Device m_device;
  std::unique_ptr<nn::ProcessGroup> m_group;
  Trainee m_trainee;
  std::optional<Batches> m_train, m_valid, m_test;
  TrainingPace m_pace;
  std::optional<TrainingNoise> m_noise;
  std::shared_ptr<const LinearGaussian> m_yardstick;
  std::optional<Optimiser> m_optimiser;
  TrainingState m_state;
  Json m_facts = Json::object();
  double m_lossSum = 0.0, m_normSum = 0.0;
  int64_t m_lossCount = 0, m_skipped = 0, m_sinceCheckpoint = 0;
  double m_lastTrainBits = 0.0, m_lastTestNats = 0.0;
};

}  // namespace

TrainResult train(const DataSet& data, const TrainRequest& request,
                  std::span<const ModelFamily> families, Progress& progress) {
  if (!request.config.is_object() || !request.config.contains("model"))
    throw InputError({.path = request.configOrigin},
                     "an object with 'family', 'model' and 'training'", "something else");
  Run run(data, request, families);
  try {
    return run.execute(progress);
  } catch (const std::exception& e) {
    run.group().abandon(e.what());
    throw;
  }
}

}  // namespace marey

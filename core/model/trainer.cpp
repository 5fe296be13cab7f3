#include "model/trainer.h"

#include <chrono>
#include <cmath>

#include <ATen/CPUGeneratorImpl.h>

#include "base/atomic_file.h"
#include "model/build.h"
#include "model/evaluation.h"
#include "model/kept_checkpoints.h"
#include "model/optimiser.h"
#include "model/pose_units.h"
#include "model/run_files.h"
#include "model/training_data.h"
#include "model/training_state.h"
#include "model/weights.h"

namespace marey {
namespace fs = std::filesystem;
namespace {

constexpr int kNonFiniteLimit = 5;

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

/// What happened since the last checkpoint.
struct Since {
  double loss = 0.0, norm = 0.0;  ///< sums over the steps taken
  std::vector<double> terms;
  int64_t taken = 0, skipped = 0;

  void add(const StepReport& step) {
    loss += step.loss;
    norm += step.norm;
    terms.resize(step.terms.size(), 0.0);
    for (size_t i = 0; i < terms.size(); ++i) terms[i] += step.terms[i];
    ++taken;
  }
  int64_t steps() const { return taken + skipped; }
  double mean(double sum) const {
    return taken > 0 ? sum / static_cast<double>(taken) : std::nan("");
  }
};

/// Losses of a checkpoint, in the objective's unit; NaN where there are no such clips.
struct Judged {
  double valid = std::nan(""), test = std::nan("");
};

/// Of a model whose poses are those of the data.
TensorFile initialWeights(const fs::path& path, const FeatureSpec& features) {
  TensorFile out = readTensorFile(path);
  if (!out.metadata.contains("features")) return out;
  const auto found = featureSpecFromJson(out.metadata["features"], path.string());
  if (found.layout != features.layout)
    throw InputError({.path = path.string(), .item = "feature layout"},
                     "'" + features.layout + "', as the data set has", "'" + found.layout + "'");
  return out;
}

/// One training run: what it is given and what it carries.
class Run {
 public:
  Run(const DataSet& data, const TrainRequest& request, const ModelFamily& family)
      : m_data(data),
        m_request(request),
        m_family(family),
        m_config(trainingConfigFromJson(request.config.value("training", Json::object()),
                                        request.configOrigin)),
        m_device(deviceOf(request)),
        m_group(nn::joinProcesses(request.process,
                                  nn::meetingPoint(fs::weakly_canonical(request.run).string()))) {
    m_trainee = m_family.makeTrainee(request.config.at("model"), request.configOrigin,
                                     {data.poseDim(), data.controlDim(), data.skeleton,
                                      data.standardiser, data.options.features},
                                     request.seed);
    m_objective = m_trainee.net->objective();
    m_training.emplace(
        trainingDataOf(data, m_config, *m_trainee.net, m_device, request.configOrigin));
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
    else if (idle || m_since.steps() > 0)
      checkpoint();
    if (decision == kCancel) throw CancelledError();
    return {.steps = m_state.step,
            .objective = m_objective,
            .train = m_lastTrain,
            .valid = m_state.bestValid,
            .testNatsPerFrame = m_lastTestNats,
            .testUnit = likelihoodUnit(m_data.options.features),
            .best = m_request.run / "best.marey",
            .last = m_request.run / "last.marey"};
  }

  nn::ProcessGroup& group() { return *m_group; }

 private:
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
    if (!m_request.resume) return beginNew();
    m_state = loadState(statePath, net, m_optimiser->adam, identity());
    m_facts = readJson(m_request.run / "config.json").value("facts", Json::object());
    if (m_group->leads()) cutLog(m_request.run, m_state.step);
  }

  void beginNew() {
    TrainableModel& net = *m_trainee.net;
    if (m_request.init.empty()) {
      m_facts = net.initialise(m_training->framesFor(net));
    } else {
      loadWeights(net, initialWeights(m_request.init, m_data.options.features),
                  m_request.init.string());
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
                                              {"objective", m_objective.name},
                                              {"facts", m_facts},
                                              {"data", m_data.hash}});
    startLog(m_request.run, shownUnit(m_objective), m_objective.terms);
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
    auto batch = m_training->train.forStep(m_request.seed, m_state.step, m_config.batch);
    batch.step = m_state.step;
    batch.draws = net.draw(batch, generator);
    batch.noise = m_training->noise.draw(batch, generator);
    const StepReport report =
        m_optimiser->step(batch, learningRateAt(m_config, m_state.step), m_state.updates + 1);
    if (report.taken) {
      m_state.nonFinite = 0;
      ++m_state.updates;
      addToAverage(net, m_config.ema, m_state);
      m_since.add(report);
    } else {
      skip(net);
    }
    ++m_state.step;
  }

  void skip(const TrainableModel& net) {
    ++m_since.skipped;
    if (++m_state.nonFinite < kNonFiniteLimit) return;
    throw NumericError(fmt::format(
        "training: {} steps in a row gave a loss or gradient that is not finite; first bad layer: "
        "{}. The last checkpoint is kept; try a lower learning rate",
        kNonFiniteLimit, suspectLayer(net)));
  }

  double lossOf(const std::optional<Batches>& batches) {
    if (!batches) return std::nan("");
    return meanLoss(*m_trainee.net, *batches, m_training->noise, *m_group);
  }

  /// Of a loss in nats per frame of standardised poses: in likelihoodUnit.
  double natsPerFrame(double loss) const {
    if (!m_objective.likelihood) return std::nan("");
    const FeatureSpec& features = m_data.options.features;
    return -loss + toShownPerFrame(m_data.standardiser,
                                   channelsOf(features, m_data.skeleton.get(), m_data.poseDim()));
  }

  double shown(double loss) const { return shownLoss(m_objective, loss); }

  void checkpoint() {
    Judged judged;
    std::string model;
    {
      const AveragedWeights averaged(*m_trainee.net, m_state);
      judged = {lossOf(m_training->valid), lossOf(m_training->test)};
      if (m_group->leads()) model = serialise(exportModel(judged));
    }
    m_lastTrain = shown(m_since.mean(m_since.loss));
    m_lastTestNats = natsPerFrame(judged.test);
    const double criterion = std::isnan(judged.valid) ? m_lastTrain : shown(judged.valid);
    const bool best = criterion < m_state.bestValid;
    if (best) m_state.bestValid = criterion;
    if (m_group->leads()) write(model, best, judged);
    m_since = {};
  }

  void write(const std::string& model, bool best, const Judged& judged) {
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
    appendLog(m_request.run, logRow(judged));
    // Last: a run that is killed before this line goes on from the checkpoint before.
    saveState(m_request.run / "state.marey", m_state, *m_trainee.net, m_optimiser->adam,
              identity());
  }

  LogRow logRow(const Judged& judged) const {
    LogRow out{.step = m_state.step,
               .seconds = m_state.seconds,
               .learningRate = learningRateAt(m_config, m_state.step - 1),
               .train = m_lastTrain,
               .valid = shown(judged.valid),
               .test = shown(judged.test),
               .gradientNorm = m_since.taken > 0 ? m_since.mean(m_since.norm) : 0.0,
               .skipped = m_since.skipped};
    for (size_t i = 0; i < m_objective.terms.size(); ++i)
      out.terms.emplace_back(m_objective.terms[i], i < m_since.terms.size()
                                                       ? m_since.mean(m_since.terms[i])
                                                       : std::nan(""));
    return out;
  }

  /// A run that had ended says again what it reached.
  void restate() {
    const AveragedWeights averaged(*m_trainee.net, m_state);
    m_lastTrain = std::nan("");
    m_lastTestNats = natsPerFrame(lossOf(m_training->test));
  }

  TensorFile exportModel(const Judged& judged) {
    ModelInfo info = commonInfo(m_data, m_request, m_family);
    info.observation = m_training->noise.observation();
    info.yardstick = m_training->yardstick;
    info.config = m_trainee.config;
    info.provenance["objective"] = m_objective.name;
    info.provenance["steps"] = m_state.step;
    info.provenance["training_seconds"] = m_state.seconds;
    info.provenance["training"] = toJson(m_config);
    info.provenance["facts"] = m_facts;
    info.provenance["training_pace"] = toJson(m_training->pace);
    if (!m_training->noise.none())
      info.provenance["floor_directions"] =
          m_training->noise.floorDirections(*m_trainee.net, m_training->framesFor(*m_trainee.net));
    addLosses(judged, info.provenance);
    TensorFile file;
    storeCommon(info, file);
    storeWeights(*m_trainee.net, file);
    return file;
  }

  void addLosses(const Judged& judged, Json& provenance) const {
    const bool likelihood = m_objective.likelihood;
    const auto add = [&](const char* which, double loss) {
      if (std::isnan(loss)) return;
      provenance[std::string(which) + (likelihood ? "_nats_per_frame" : "_loss")] =
          likelihood ? natsPerFrame(loss) : loss;
    };
    add("valid", judged.valid);
    add("test", judged.test);
    if (likelihood)
      provenance["likelihood_unit"] = likelihoodUnit(m_data.options.features);
    else
      provenance["loss_unit"] = m_objective.unit;
  }

  void tell(Progress& progress, double rate) {
    const double bySteps = static_cast<double>(m_state.step) /
                           static_cast<double>(m_request.steps.value_or(m_config.steps));
    const double byTime = m_request.minutes ? m_state.seconds / (60.0 * *m_request.minutes) : 0.0;
    const auto valid = std::isfinite(m_state.bestValid)
                           ? fmt::format(" (valid {:.4g})", m_state.bestValid)
                           : std::string();
    progress.report(std::min(1.0, std::max(bySteps, byTime)),
                    fmt::format("step {}, {:.2f} steps/s, {:.4g} {}{}", m_state.step, rate,
                                shown(m_since.mean(m_since.loss)), shownUnit(m_objective), valid));
  }

  const DataSet& m_data;
  const TrainRequest& m_request;
  const ModelFamily& m_family;
  TrainingConfig m_config;
  torch::Device m_device;
  std::unique_ptr<nn::ProcessGroup> m_group;
  Trainee m_trainee;
  Objective m_objective;
  std::optional<TrainingData> m_training;
  std::optional<Optimiser> m_optimiser;
  TrainingState m_state;
  Since m_since;
  Json m_facts = Json::object();
  double m_lastTrain = std::nan(""), m_lastTestNats = std::nan("");
};

}  // namespace

TrainResult trainByGradient(const DataSet& data, const TrainRequest& request,
                            const ModelFamily& family, Progress& progress) {
  Run run(data, request, family);
  try {
    return run.execute(progress);
  } catch (const std::exception& e) {
    run.group().abandon(e.what());
    throw;
  }
}

}  // namespace marey

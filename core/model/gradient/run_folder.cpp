#include "model/gradient/run_folder.h"

#include "base/atomic_file.h"
#include "model/gradient/build.h"
#include "model/gradient/kept_checkpoints.h"
#include "model/gradient/run_files.h"
#include "model/gradient/weights.h"

namespace marey {
namespace fs = std::filesystem;
namespace {

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

fs::path stateOf(const fs::path& run) {
  return run / "state.marey";
}

}  // namespace

TrainingState RunFolder::begin(Optimiser& optimiser) {
  const TrainRequest& request = m_setup.request;
  const fs::path statePath = stateOf(request.run);
  const bool exists = fs::exists(statePath);
  if (request.resume && !exists)
    throw FileError(fmt::format("{}: nothing to resume", statePath.string()));
  if (!request.resume && exists)
    throw InputError({.path = request.run.string()}, "a new folder, or --resume", "a run");
  m_setup.group->requireSame("run", m_setup.identity().dump());
  if (!request.resume) return beginNew();
  TrainingState out = loadState(statePath, m_setup.net(), optimiser, m_setup.identity());
  m_facts = readJson(request.run / "config.json").value("facts", Json::object());
  if (m_setup.leads()) cutLog(request.run, out.step);
  return out;
}

void RunFolder::startNet() {
  TrainableModel& net = m_setup.net();
  const fs::path& init = m_setup.request.init;
  if (init.empty()) {
    m_facts = net.initialise(m_setup.training.framesFor(net));
  } else {
    loadWeights(net, initialWeights(init, m_setup.data.options.features), init.string());
    m_facts = {{"initial_weights", init.filename().string()}};
  }
  // Another kind of processor may have rounded its start otherwise.
  for (auto& p : net.parameters()) m_setup.group->spread(p);
  for (auto& b : net.buffers()) m_setup.group->spread(b);
}

TrainingState RunFolder::beginNew() {
  startNet();
  TrainingState out;
  if (m_setup.config.ema > 0)
    for (const auto& item : m_setup.net().named_parameters())
      out.average[item.key()] = item.value().detach().clone();
  if (!m_setup.leads()) return out;
  const TrainRequest& request = m_setup.request;
  writeJson(request.run / "config.json", {{"config", request.config},
                                          {"seed", request.seed},
                                          {"objective", m_setup.objective.name},
                                          {"facts", m_facts},
                                          {"data", m_setup.data.hash}});
  startLog(request.run, shownUnit(m_setup.objective), m_setup.objective.terms);
  return out;
}

TensorFile RunFolder::exported(const TrainingState& state, const Judged& judged) const {
  const TrainingData& training = m_setup.training;
  ModelInfo info = commonInfo(m_setup.data, m_setup.request, m_setup.family);
  info.observation = training.noise.observation();
  info.yardstick = training.yardstick;
  info.config = m_setup.trainee.config;
  info.provenance["objective"] = m_setup.objective.name;
  info.provenance["steps"] = state.step;
  info.provenance["training_seconds"] = state.seconds;
  info.provenance["training"] = toJson(m_setup.config);
  info.provenance["facts"] = m_facts;
  info.provenance["training_pace"] = toJson(training.pace);
  if (!training.noise.none())
    info.provenance["floor_directions"] =
        training.noise.floorDirections(m_setup.net(), training.framesFor(m_setup.net()));
  addTo(info.provenance, m_setup, judged);
  TensorFile file;
  storeCommon(info, file);
  storeWeights(m_setup.net(), file);
  return file;
}

void RunFolder::appendRow(const Checkpoint& checkpoint, const TrainingState& state,
                          const Since& since) const {
  const Objective& objective = m_setup.objective;
  LogRow row{.step = state.step,
             .seconds = state.seconds,
             .learningRate = m_setup.learningRateAt(state.step - 1),
             .train = checkpoint.train,
             .valid = shownLoss(objective, checkpoint.judged.valid),
             .test = shownLoss(objective, checkpoint.judged.test),
             .gradientNorm = since.taken > 0 ? since.mean(since.norm) : 0.0,
             .skipped = since.skipped};
  for (size_t i = 0; i < objective.terms.size(); ++i)
    row.terms.emplace_back(objective.terms[i],
                           i < since.terms.size() ? since.mean(since.terms[i]) : std::nan(""));
  appendLog(m_setup.request.run, row);
}

void RunFolder::write(const Checkpoint& checkpoint, TrainingState& state, const Since& since,
                      const Optimiser& optimiser) const {
  const fs::path& run = m_setup.request.run;
  const TrainingConfig& config = m_setup.config;
  writeFileAtomically(run / "last.marey", checkpoint.model);
  if (checkpoint.best) writeFileAtomically(run / "best.marey", checkpoint.model);
  const auto due = config.snapshotMinutes > 0
                       ? static_cast<int64_t>(state.seconds / 60.0 / config.snapshotMinutes)
                       : 0;
  if (due > state.snapshots) {
    state.snapshots = due;
    writeFileAtomically(run / "snapshots" / fmt::format("step_{:07}.marey", state.step),
                        checkpoint.model);
  }
  keepCheckpoint(run, config, state.step, checkpoint.model);
  appendRow(checkpoint, state, since);
  saveState(stateOf(run), state, m_setup.net(), optimiser, m_setup.identity());
}

}  // namespace marey

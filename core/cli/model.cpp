// marey model info|import|export|check: models as files.
#include <cmath>
#include <memory>

#include "families.h"

#include "base/atomic_file.h"
#include "base/npy.h"
#include "cli/command.h"
#include "model/conformance.h"
#include "model/gradient/learnt.h"
#include "model/likelihood.h"
#include "model/model_card.h"
#include "model/pose_units.h"
#include "motion/roles.h"

namespace marey::cli {
namespace {

struct Options {
  std::string model, config, family, out, checkpoint, data, vectors, name, stateDict, card;
  double temperature = -1.0;  ///< below 0: not given
  bool half = false;
};

ModelInfo describeConfig(const std::string& path) {
  const Json config = readJson(path);
  return familyOf(config, modelFamilies(), path).describe(config, path);
}

Json infoJson(const ModelInfo& info) {
  Json out = {{"family", info.family},          {"name", info.variant},
              {"parameters", info.parameters},  {"pose_dim", info.poseDim},
              {"control_dim", info.controlDim}, {"context", info.context},
              {"lookahead", info.lookahead},    {"config", info.config}};
  out["options"] = Json::array();
  for (const SamplingOption& option : info.optionSchema) out["options"].push_back(toJson(option));
  out["facts"] = Json::object();
  for (const auto& [name, value] : factsOf(info)) out["facts"][name] = value;
  if (info.hash.empty()) return out;  // a configuration, no model
  out["standardiser"] = !info.standardiser.empty();
  out["joints"] = info.skeleton ? info.skeleton->names : std::vector<std::string>{};
  out["fps"] = info.features.fps;
  out["layout"] = info.features.layout;
  if (info.knowsControl()) out["control"] = toJson(info.features.control);
  out["hash"] = info.hash;
  out["provenance"] = info.provenance;
  out["observation"] = info.observation.none() ? Json() : toJson(info.observation);
  out["floor_directions"] = finiteOrNull(floorDirectionsOf(info));
  out["likelihood_unit"] = likelihoodUnit(info);
  out["linear_gaussian"] = info.yardstick != nullptr;
  return out;
}

std::string adviceText(const ModelAdvice& advice) {
  std::string out = advice.temperature
                        ? fmt::format("recommended temperature: {:g}\n", *advice.temperature)
                        : "no temperature is recommended\n";
  if (advice.card.empty()) return out + "no card\n";
  const std::string from = advice.cardFile.empty() ? "" : " (" + advice.cardFile.string() + ")";
  return out + "card" + from + ":\n" + advice.card;
}

void runInfo(const Options& o, const Context& context) {
  if (o.model.empty() == o.config.empty())
    throw UsageError("model info: give a MODEL or --config FILE, not both");
  const ModelInfo info =
      o.config.empty() ? loadModel(o.model, modelFamilies())->info() : describeConfig(o.config);
  Json json = infoJson(info);
  std::string text = fmt::format(
      "{} {}: {:.2f} M parameters; {} pose and {} control values, context {} frames, look-ahead "
      "{}\n",
      info.family, info.variant, static_cast<double>(info.parameters) / 1e6, info.poseDim,
      info.controlDim, info.context, info.lookahead);
  for (const auto& [name, value] : factsOf(info)) text += fmt::format("{}: {}\n", name, value);
  text += info.config.dump(2) + "\n";
  if (!info.hash.empty()) {
    text += info.standardiser.empty()
                ? "no standardiser: poses and likelihoods are in standardised units\n"
                : "with standardiser\n";
    if (info.knowsControl()) text += "control: " + summaryOf(info.features.control) + "\n";
    text += floorText(info) + "\n";
    text += "provenance: " + info.provenance.dump(2) + "\n";
    const ModelAdvice advice = modelAdvice(o.model);
    text += adviceText(advice);
    json["recommended"] = Json::object();
    if (advice.temperature) json["recommended"]["temperature"] = *advice.temperature;
    json["card"] = advice.card;
  }
  context.print(json, text);
}

void runImport(const Options& o, const Context& context) {
  const Standardiser standardiser =
      o.data.empty() ? Standardiser{} : standardiserFromArchive(o.data);
  const Json config = readJson(o.config);
  const ModelFamily& family = familyOf(config, modelFamilies(), o.config);
  if (!family.importCheckpoint)
    throw InputError({.path = o.config, .item = "key 'family'"},
                     "a family whose authors' checkpoints are known", "'" + family.name + "'");
  const auto model = family.importCheckpoint({.checkpoint = o.checkpoint,
                                              .config = config,
                                              .configOrigin = o.config,
                                              .standardiser = standardiser,
                                              .variant = std::filesystem::path(o.out).stem(),
                                              .stateDict = o.stateDict});
  writeTensorFile(o.out, model->save());
  Json result = infoJson(model->info());
  result["written"] = o.out;
  result["provenance"] = model->info().provenance;
  const Json& provenance = model->info().provenance;
  std::string text = fmt::format(
      "{}: {:.2f} M parameters{}\nstate dict: {}", o.out,
      static_cast<double>(model->info().parameters) / 1e6,
      standardiser.empty() ? ", without standardiser (give --data CLIPS.npz to refit it)" : "",
      provenance["state_dict"].get<std::string>());
  std::string leftOut;
  for (const Json& name : provenance["left_out"])
    leftOut += (leftOut.empty() ? "" : ", ") + name.get<std::string>();
  if (!leftOut.empty()) text += "\nleft out: " + leftOut;
  context.print(result, text);
}

/// Half precision leaves standardisers alone, and what was fitted in closed form: their rounding
/// would move every pose.
void halve(const ModelInfo& info, TensorFile& file) {
  for (const std::string& name :
       learntTensors(familyNamed(info.family, modelFamilies(), info.variant), info)) {
    Tensor& tensor = file.tensors.at(name);
    tensor = tensor.as(DType::F16);
  }
}

void runExport(const Options& o, const Context& context) {
  const auto model = loadModel(o.model, modelFamilies());
  TensorFile file = model->save();
  if (o.half) halve(model->info(), file);
  if (!o.name.empty()) file.metadata["variant"] = o.name;
  passAdviceOn(o.model, file.metadata);
  if (!o.card.empty()) storeAdvice(file.metadata, readFile(o.card, size_t{1} << 20), {});
  if (o.temperature >= 0.0) storeAdvice(file.metadata, {}, o.temperature);
  writeTensorFile(o.out, file);
  const auto bytes = std::filesystem::file_size(o.out);
  context.print({{"written", o.out}, {"bytes", bytes}},
                fmt::format("{}: {:.1f} MB", o.out, static_cast<double>(bytes) / 1e6));
}

std::string familyNames() {
  std::string out;
  for (const ModelFamily& family : modelFamilies())
    out += fmt::format("{}{}", out.empty() ? "" : ", ", family.name);
  return out;
}

void runExample(const Options& o, const Context& context) {
  const ModelFamily& family = familyNamed(o.family, modelFamilies(), "FAMILY");
  Json described = Json::object();
  described["title"] = family.title;
  described["config"] = family.example;
  if (!o.out.empty()) {
    writeJson(o.out, family.example);
    described["written"] = o.out;
  }
  context.print(described, o.out.empty() ? family.example.dump(2)
                                         : fmt::format("{}: {}", o.out, family.title));
}

void runCheck(const Options& o, const Context& context) {
  const auto model = loadModel(o.model, modelFamilies());
  const ConformanceErrors e = checkConformance(*model, o.vectors);
  context.print({{"latent_max_abs_error", e.latent},
                 {"loglik_max_abs_error", e.loglik},
                 {"sample_max_abs_error", e.sample},
                 {"frames", e.frames}},
                fmt::format("largest differences over {} frames: latents {:.2e}, log-likelihoods "
                            "{:.2e} nats, samples {:.2e}",
                            e.frames, e.latent, e.loglik, e.sample));
}

}  // namespace

void addModelCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* model = app.add_subcommand("model", "Look into, import, export and check models");
  model->require_subcommand(1);
  auto* info = addCommand(*model, context, "info", "What a model or a configuration is",
                          "marey model info --config resources/models/mg-a.json",
                          [o, &context] { runInfo(*o, context); });
  info->add_option("MODEL", o->model, "Model (.marey)");
  info->add_option("--config", o->config, "Hyper-parameters (JSON)");

  auto* example = addCommand(
      *model, context, "example", "A small configuration of a family, to start from",
      "marey model example FAMILY --out config.json", [o, &context] { runExample(*o, context); });
  example->add_option("FAMILY", o->family, familyNames())->required();
  example->add_option("--out", o->out, "File to write (default: print it)");

  auto* import =
      addCommand(*model, context, "import", "Read the authors' PyTorch checkpoint (.pkg, .pt)",
                 "marey model import trained.pkg --config hparams.json --data "
                 "all_locomotion_train_20fps.npz --out model.marey",
                 [o, &context] { runImport(*o, context); });
  import->add_option("CHECKPOINT", o->checkpoint, "PyTorch checkpoint; nothing in it is executed")
      ->required();
  import->add_option("--config", o->config, "The authors' hparams, or Marey's keys (JSON)")
      ->required();
  import->add_option(
      "--data", o->data,
      "Their training clips (.npz): refits the standardiser, which checkpoints lack");
  import->add_option("--state-dict", o->stateDict,
                     "Which state dict of a checkpoint that holds several: graph, ema, ...");
  import->add_option("--out", o->out, "Model to write")->required();

  auto* exporting = addCommand(*model, context, "export",
                               "Write a model in a smaller, renamed or documented form",
                               "marey model export runs/small/best.marey --half --out small.marey",
                               [o, &context] { runExport(*o, context); });
  exporting->add_option("MODEL", o->model, "Model (.marey)")->required();
  exporting->add_option("--out", o->out, "Model to write")->required();
  exporting->add_flag("--half", o->half, "Store what the network learnt in 16 bits");
  exporting->add_option("--name", o->name, "New name of the model");
  exporting->add_option("--card", o->card, "Model card (Markdown) to keep in the model");
  exporting
      ->add_option("--temperature", o->temperature,
                   "Temperature to recommend; the window takes it where the model is added")
      ->check(CLI::NonNegativeNumber);

  auto* check = addCommand(*model, context, "check", "Compare a model with reference vectors",
                           "marey model check model.marey --vectors vectors.npz",
                           [o, &context] { runCheck(*o, context); });
  check->add_option("MODEL", o->model, "Model (.marey)")->required();
  check->add_option("--vectors", o->vectors, "x, control, z, loglik_nats, z_in, x_sampled (.npz)")
      ->required();
}

}  // namespace marey::cli

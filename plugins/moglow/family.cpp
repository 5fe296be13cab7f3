#include "moglow/family.h"

#include <algorithm>

#include "model/gradient/weights.h"
#include "model/model_parts.h"
#include "moglow/engine_model.h"
#include "moglow/reference_model.h"
#include "moglow/stored_weights.h"

namespace marey::moglow {
namespace {

constexpr const char* kFamily = "moglow";

/// Of models that are trained from now on: as finely as anything about a skeleton is known.
constexpr double kObservationFloorMm = 0.5;

int64_t trainableParameters(const Config& c) {
  // In closed form: a paper-size network need not be built to be counted.
  const int64_t d = c.poseDim - c.passedChannels(), h = c.hidden,
                gates = c.cell == "lstm"  ? 4
                        : c.cell == "gru" ? 3
                                          : 1;
  const int64_t recurrent = c.cell == "feedforward" ? 0 : 1;
  int64_t net = 0;
  for (int64_t layer = 0; layer < c.layers; ++layer) {
    const int64_t inputs = layer == 0 ? d / 2 + c.conditioning() : h;
    net += gates * h * (inputs + recurrent * h + 1 + recurrent);
  }
  net += 2 * (d - d / 2) * (h + 1);
  const int64_t linear = c.lu ? 2 * d * d + d : d * d;
  return c.steps * (2 * d + linear + net);
}

std::vector<ModelFact> factsOf(const Config& c) {
  std::vector<ModelFact> out{
      {"flow", fmt::format("{} steps, {} layers of {} {} units in each coupling", c.steps, c.layers,
                           c.hidden, c.cell)}};
  if (c.based())
    out.push_back({"base", fmt::format("{}: foresees the pose, below the flow", c.poseBase)});
  if (c.observationFloorMm > 0.0)
    out.push_back({"observation floor", fmt::format("{:g} mm", c.observationFloorMm)});
  return out;
}

/// Completes what the configuration says about a model.
ModelInfo completed(ModelInfo info, const Config& config) {
  info.context = config.tau;
  info.lookahead = config.lookahead;
  info.parameters = trainableParameters(config);
  info.latent = {.width = config.poseDim, .degreesOfFreedom = config.degreesOfFreedom()};
  info.density = DensityKind::Exact;
  info.optionSchema = {temperatureOption(config.poseDim)};
  info.facts = factsOf(config);
  return info;
}

ModelInfo describe(const Json& json, const std::string& origin) {
  const Config config = configFromJson(json, origin);
  return completed(describedInfo(kFamily, json, config.poseDim, config.controlDim, toJson(config)),
                   config);
}

std::unique_ptr<MotionModel> load(TensorFile file, const std::string& origin,
                                  const LoadOptions& options) {
  ModelInfo info = loadCommon(file, origin);
  const Config config = configFromJson(info.config, origin);
  requireStoredSizes(info, config.poseDim, config.controlDim, origin);
  const BodyFacts body = bodyFacts(info.skeleton.get(), info.standardiser);
  if (options.execution != Execution::Engine) {
    auto net = std::make_shared<Net>(config, body, 0);
    loadWeights(*net, file, origin);
    const auto type = options.execution == Execution::Exact ? torch::kFloat64 : torch::kFloat32;
    return std::make_unique<ReferenceModel>(completed(std::move(info), config), std::move(net),
                                            type);
  }
  checkFlow(config, file, origin);
  auto base = loadBase(config, body, file, "base", origin);
  auto motion = config.hasMotionBase()
                    ? loadBase(config.ofMotionBase(), body, file, "motion", origin)
                    : nullptr;
  const auto precision = options.weights == WeightPrecision::BFloat16 ? nn::Precision::BFloat16
                                                                      : nn::Precision::Float32;
  return std::make_unique<EngineModel>(completed(std::move(info), config), config, std::move(file),
                                       std::move(base), std::move(motion), precision, origin);
}

/// Whether a configuration says something itself, be it what would be assumed.
bool states(const Json& json, const char* key) {
  const Json& model = json.is_object() && json.contains("model") ? json.at("model") : json;
  return model.is_object() && model.contains(key);
}

Json example() {
  return {{"family", kFamily},
          {"name", "moglow-tiny"},
          {"model", {{"tau", 3}, {"steps", 4}, {"hidden", 32}, {"dropout", 0.5}}},
          {"training",
           {{"window_s", 2.0},
            {"hop_s", 1.0},
            {"batch", 16},
            {"learning_rate", 0.002},
            {"steps", 300},
            {"checkpoint_every", 50}}}};
}

/// The authors' hparams, and the flat keys of vectors computed by their code.
bool recognises(const Json& config) {
  return config.is_object() && (config.contains("Glow") || config.contains("lstm_layers"));
}

/// The kinematic base knows feet and bones by the positions of joints.
void requirePoses(const Config& config, const FeatureSpec& features, const std::string& origin) {
  const std::string needed = "root-positions";
  if (config.poseBase == "kinematic" && features.layout != needed)
    throw InputError({.path = origin, .item = "key 'model.pose_base'"},
                     "none or linear for " + features.layout + " poses",
                     "kinematic, which needs data of marey prepare --layout " + needed);
}

Trainee makeTrainee(const Json& modelConfig, const std::string& origin, const TraineeData& data,
                    uint64_t seed) {
  Config config = configFromJson(modelConfig, origin);
  config.poseDim = data.poseDim;
  config.controlDim = data.controlDim;
  requirePoses(config, data.features, origin);
  if (!states(modelConfig, "observation_floor_mm")) config.observationFloorMm = kObservationFloorMm;
  // Stored models that say nothing were fitted to trained lengths; new ones follow the body.
  if (!states(modelConfig, "bone_lengths") && config.poseBase == "kinematic" &&
      config.hasMotionBase())
    config.boneLengths = "history";
  const BodyFacts body = bodyFacts(data.skeleton.get(), data.standardiser);
  config.contacts = 2 * static_cast<int>(body.feet.size());
  return {std::make_shared<Net>(config, body, seed), toJson(config)};
}

}  // namespace

ModelFamily family() {
  return {.name = kFamily,
          .title = "MoGlow: an autoregressive normalising flow (Henter et al. 2020)",
          .example = example(),
          .load = load,
          .describe = describe,
          .recognises = recognises,
          .makeTrainee = makeTrainee,
#ifdef MAREY_IMPORTS
          .importCheckpoint = importCheckpoint
#endif
  };
}

}  // namespace marey::moglow

#include "vae/family.h"

#include "vae/clip_request.h"
#include "vae/engine_model.h"
#include "vae/reference_model.h"

#include "base/error.h"
#include "model/gradient/weights.h"
#include "model/model_parts.h"

namespace marey::vae {
namespace {

constexpr const char* kFamily = "vae";

/// Completes what the configuration says about a model.
ModelInfo completed(ModelInfo info, const Config& config) {
  info.parameters = parametersOf(config);
  info.latent = latentSpec(config);
  info.causal = false;
  info.optionSchema = {temperatureOption(info.latent.width)};
  if (config.gaussian())
    info.optionSchema.push_back(
        {.name = "decoder_noise",
         .title = "Decoder's noise",
         .about = "Whether motion has the decoder's noise around its mean, which makes it tremble",
         .kind = SamplingOption::Kind::Switch,
         .high = 1.0,
         .first = config.latent,
         .count = config.poseDim});
  info.facts = {{"net", fmt::format("{} bidirectional layers of {} units each way in encoder and "
                                    "decoder",
                                    config.layers, config.hidden)},
                {"values a clip", std::to_string(config.latent)},
                {"decoder", config.decoder}};
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
  info = completed(std::move(info), config);
  auto net = std::make_shared<Net>(config, 0);
  loadWeights(*net, file, origin);
  if (options.execution != Execution::Engine)
    return std::make_unique<ReferenceModel>(
        std::move(info), std::move(net),
        options.execution == Execution::Exact ? torch::kFloat64 : torch::kFloat32);
  const auto precision = options.weights == WeightPrecision::BFloat16 ? nn::Precision::BFloat16
                                                                      : nn::Precision::Float32;
  return std::make_unique<EngineModel>(std::move(info), config, std::move(file), precision);
}

Trainee makeTrainee(const Json& modelConfig, const std::string& origin, const TraineeData& data,
                    uint64_t seed) {
  Config config = configFromJson(modelConfig, origin);
  config.poseDim = data.poseDim;
  config.controlDim = data.controlDim;
  return {std::make_shared<Net>(config, seed), toJson(config)};
}

Json example() {
  return {{"family", kFamily},
          {"name", "vae-small"},
          {"model", {{"hidden", 32}, {"layers", 1}, {"latent", 2}, {"decoder", "deterministic"}}},
          {"training",
           {{"window_s", 2.0},
            {"hop_s", 1.0},
            {"batch", 16},
            {"learning_rate", 0.003},
            {"steps", 500},
            {"checkpoint_every", 50}}}};
}

}  // namespace

ModelFamily family() {
  return {.name = kFamily,
          .title =
              "VAE: an autoencoder of whole clips with bidirectional LSTMs (Henter et al. "
              "2020, Sec. 4.3)",
          .example = example(),
          .load = load,
          .describe = describe,
          .makeTrainee = makeTrainee};
}

}  // namespace marey::vae

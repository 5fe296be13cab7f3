#include "rnn/family.h"

#include "rnn/models.h"

#include "base/error.h"
#include "model/gradient/weights.h"
#include "model/model_parts.h"

namespace marey::rnn {
namespace {

constexpr const char* kFamily = "rnn";

/// Completes what the configuration says about a model.
ModelInfo completed(ModelInfo info, const Config& config) {
  info.context = config.past;
  info.lookahead = config.lookahead;
  info.parameters = config.parameters();
  info.facts = {
      {"net", fmt::format("{} layers of {} {} units", config.layers, config.hidden, config.cell)},
      {"sees its own poses", config.feedback ? "the one before" : "no"}};
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
  auto net = std::make_shared<Net>(config, 0);
  loadWeights(*net, file, origin);
  info = completed(std::move(info), config);
  const auto precision = options.weights == WeightPrecision::BFloat16 ? nn::Precision::BFloat16
                                                                      : nn::Precision::Float32;
  if (options.execution == Execution::Engine)
    return std::make_unique<EngineModel>(std::move(info), config, std::move(file), precision);
  const auto type = options.execution == Execution::Exact ? torch::kFloat64 : torch::kFloat32;
  return std::make_unique<ReferenceModel>(std::move(info), std::move(net), type);
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
          {"name", "rnn-small"},
          {"model", {{"hidden", 64}, {"layers", 1}, {"cell", "lstm"}}},
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
          .title = "RNN: from control to poses, deterministic (Henter et al. 2020, Sec. 4.3)",
          .example = example(),
          .load = load,
          .describe = describe,
          .makeTrainee = makeTrainee};
}

}  // namespace marey::rnn

// The way from a configuration and a data set to a model, whatever its family.
#include "model/gradient/build.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "model/training_pace.h"

namespace marey {
namespace {

/// A configuration that states the size of its data must mean these data.
void requireStatedSizes(const TrainRequest& request, const DataSet& data) {
  const Json& model = request.config.at("model");
  if (!model.is_object()) return;
  for (const auto& [key, size] :
       {std::pair{"pose_dim", data.poseDim()}, std::pair{"control_dim", data.controlDim()}})
    if (model.contains(key) && model[key] != size)
      throwInput({.path = request.configOrigin, .item = fmt::format("key 'model.{}'", key)},
                 fmt::format("{}, as the data set has", size), "{}", model[key].dump());
}

/// Without gradients: made at once, and of no use half-made.
TrainResult buildAtOnce(const DataSet& data, const TrainRequest& request, const ModelFamily& family,
                        Progress& progress) {
  const auto last = request.run / "last.marey", best = request.run / "best.marey";
  if (request.resume || !request.init.empty())
    throw InputError({.path = request.configOrigin, .item = "key 'family'"},
                     "a family that is trained (for --resume and --init)",
                     "'" + family.name + "', which is built at once");
  if (std::filesystem::exists(last))
    throw InputError({.path = request.run.string()}, "a new folder", "a run");
  if (request.process.rank != 0) return {.best = best, .last = last};
  TensorFile file =
      family.build(data, request.config.at("model"), request.configOrigin, request.seed, progress);
  ModelInfo info = commonInfo(data, request, family);
  info.config = file.metadata.value("config", Json::object());
  std::vector<FeatureSequence> recorded = data.train;
  info.provenance["training_pace"] = toJson(trainingPace(recorded, data.options.features.fps));
  storeCommon(info, file);
  const std::string model = serialise(file);
  writeJson(request.run / "config.json",
            {{"config", request.config}, {"seed", request.seed}, {"data", data.hash}});
  writeFileAtomically(best, model);
  writeFileAtomically(last, model);
  return {.objective = {.name = "none", .unit = ""}, .best = best, .last = last};
}

}  // namespace

ModelInfo commonInfo(const DataSet& data, const TrainRequest& request, const ModelFamily& family) {
  ModelInfo out;
  out.family = family.name;
  out.variant = request.config.value("name", family.name);
  out.poseDim = data.poseDim();
  out.controlDim = data.controlDim();
  out.features = data.options.features;
  out.skeleton = data.skeleton;
  out.standardiser = data.standardiser;
  out.provenance = {{"data", data.hash},
                    {"training_clips", data.train.size()},
                    {"seed", request.seed},
                    {"bone_lengths_m", data.boneLengthsM},
                    {"command", request.command}};
  return out;
}

TrainResult train(const DataSet& data, const TrainRequest& request,
                  std::span<const ModelFamily> families, Progress& progress) {
  if (!request.config.is_object() || !request.config.contains("model"))
    throw InputError({.path = request.configOrigin},
                     "an object with 'family', 'model' and 'training'", "something else");
  requireStatedSizes(request, data);
  requireFinite(data.train, "training data");
  requireFinite(data.test, "test data");
  const ModelFamily& family = familyOf(request.config, families, request.configOrigin);
  return family.build ? buildAtOnce(data, request, family, progress)
                      : trainByGradient(data, request, family, progress);
}

}  // namespace marey

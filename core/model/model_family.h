// What a family of motion models declares: how its models are described, stored, made and imported.
// Families stand in one explicit list (plugins/families.h); nothing else names them.
#pragma once

#include "base/job.h"
#include "model/motion_model.h"

namespace marey {

class TrainableModel;  // model/gradient/trainable.h: libtorch inside
struct DataSet;        // model/data_set.h

/// What a new network must know of its data.
struct TraineeData {
  int poseDim = 0, controlDim = 0;
  std::shared_ptr<const Skeleton> skeleton;
  Standardiser standardiser;
  FeatureSpec features;
};

/// A freshly made network, ready to be trained.
struct Trainee {
  std::shared_ptr<TrainableModel> net;
  Json config;  ///< hyper-parameters as really used
};

/// A checkpoint of another program that is to become a model.
struct ImportRequest {
  std::string checkpoint;  ///< file; nothing in it is executed
  Json config;             ///< the authors' hyper-parameters, or Marey's keys
  std::string configOrigin;
  Standardiser standardiser;  ///< empty: the model is marked as such
  std::string variant;        ///< its name
  std::string stateDict;      ///< which of several in the file; empty: the only one, or an error
};

struct ModelFamily {
  std::string name;
  std::string title;  ///< one line for people: what it is, and its source
  /// A small configuration ({"family", "name", "model", "training"}) that trains in a minute or so:
  /// what a new file starts from.
  Json example;
  /// From a stored model. Strict: unknown, missing, mis-shaped or non-finite tensors throw
  /// InputError naming `origin`. The file is handed over, so that weights are held once.
  std::function<std::unique_ptr<MotionModel>(TensorFile, const std::string& origin,
                                             const LoadOptions& options)>
      load;
  /// What a configuration's models are: number of trainable parameters, latent, context, without
  /// building one.
  std::function<ModelInfo(const Json& config, const std::string& origin)> describe;
  /// Whether a configuration without a "family" key is of this family (files of its authors);
  /// null: never.
  std::function<bool(const Json& config)> recognises = {};

  // One of the two:
  /// Random weights from `seed`, to be trained by gradient (model/gradient/trainer.h).
  std::function<Trainee(const Json& modelConfig, const std::string& origin, const TraineeData& data,
                        uint64_t seed)>
      makeTrainee = {};
  /// A stored model from a data set, without gradients: storeCommon's part is completed by the
  /// caller (model/gradient/build.h). Throws InputError and CancelledError.
  std::function<TensorFile(const DataSet& data, const Json& modelConfig, const std::string& origin,
                           uint64_t seed, Progress& progress)>
      build = {};

  /// A model from a checkpoint of its authors; null where none are known. Throws InputError for
  /// missing, extra, mis-shaped or non-finite tensors.
  std::function<std::unique_ptr<MotionModel>(const ImportRequest&)> importCheckpoint = {};
};

/// Of configuration files; those without the key are of version 1.
inline constexpr int kConfigVersion = 1;
/// Throws InputError for a key beside those of a configuration ({"family", "name", "model", ...}),
/// and for a newer version. A file of a family's authors, which has neither "family" nor "model",
/// is that family's own affair.
void requireKnownConfigKeys(const Json& config, const std::string& origin);

const ModelFamily& familyNamed(const std::string& name, std::span<const ModelFamily> families,
                               const std::string& origin);
/// That of a configuration: its "family", or the one that recognises it. Throws InputError, also
/// for unknown keys.
const ModelFamily& familyOf(const Json& config, std::span<const ModelFamily> families,
                            const std::string& origin);

/// What a sampling of a stored model takes. Its weights are not read. Throws FileError or
/// InputError.
std::vector<SamplingOption> optionSchemaOf(const std::string& path,
                                           std::span<const ModelFamily> families);

/// Stored models carry "family" in their metadata. Throws InputError for unknown families.
std::unique_ptr<MotionModel> loadModel(const std::string& path,
                                       std::span<const ModelFamily> families,
                                       const LoadOptions& options = {});

}  // namespace marey

// From a configuration and a data set to a model: the family says how.
#pragma once

#include "model/gradient/trainer.h"

namespace marey {

/// A model of the configuration's family, by gradient or as the family builds it. The latter writes
/// config.json, last.marey and best.marey (the same), and has nothing to resume.
TrainResult train(const DataSet& data, const TrainRequest& request,
                  std::span<const ModelFamily> families, Progress& progress);

/// What is known of a model before it is made: data, names and provenance. Its own hyper-parameters
/// are not.
ModelInfo commonInfo(const DataSet& data, const TrainRequest& request, const ModelFamily& family);

}  // namespace marey

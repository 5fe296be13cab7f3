// How fast a model samples and scores, against its plain path and against what the machine can do.
#pragma once

#include <span>
#include <string>

#include "base/job.h"
#include "model/model_family.h"

namespace marey {

struct ModelBenchSpec {
  Json config;  ///< as for training; weights are random
  std::string origin;
  int batch = 1;    ///< motions that advance together, or clips scored together
  int frames = 50;  ///< of each
  WeightPrecision weights = WeightPrecision::Float32;
  bool reference = true;  ///< whether the plain path is measured too
  uint64_t seed = 1;
};

/// Times are medians, milliseconds for one frame of the whole batch.
struct ModelBenchResult {
  double msPerFrame = 0.0, bestMsPerFrame = 0.0;
  double referenceMsPerFrame = 0.0;
  /// Sampling: of the first and the last third of the frames.
  double firstMsPerFrame = 0.0, lastMsPerFrame = 0.0;
  double maxDifference = 0.0;  ///< between the two paths: poses of the first 50 frames, or nats
  double gflops = 0.0;         ///< two operations per parameter, motion and frame
  double sgemmGflops = 0.0;    ///< of the machine, median over the same time
  double weightGbPerS = 0.0;   ///< all weights once per frame of the batch
  double readGbPerS = 0.0;     ///< of the machine, for as many bytes as the weights have
  int64_t parameters = 0;
};

/// Runs both paths in turn. Throws InputError for a bad configuration or a batch or number of
/// frames below one; CancelledError.
ModelBenchResult benchSample(const ModelBenchSpec& spec, const ModelFamily& family,
                             Progress& progress);
ModelBenchResult benchScore(const ModelBenchSpec& spec, const ModelFamily& family,
                            Progress& progress);

/// A stored model of random weights. Those that start at zero are drawn too, so that no part of
/// the model is without effect.
TensorFile randomModel(const Json& config, const std::string& origin, const ModelFamily& family,
                       uint64_t seed);

}  // namespace marey

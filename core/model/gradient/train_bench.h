// How fast a model trains, against the plain path and against what the machine can do.
#pragma once

#include "base/job.h"
#include "model/model_family.h"

namespace marey {

struct TrainBenchSpec {
  Json config;  ///< as for training; weights are random
  std::string origin;
  int batch = 100;  ///< windows
  int frames = 70;  ///< scored in each
  int steps = 8;    ///< measured on each path
  bool reference = true;
  uint64_t seed = 1;
};

/// Times are medians over whole steps: dropout, loss, gradient, clipping and Adam.
struct TrainBenchResult {
  double msPerStep = 0.0, bestMsPerStep = 0.0;
  double referenceMsPerStep = 0.0, bestReferenceMsPerStep = 0.0;
  double lossNats = 0.0;       ///< per frame, of the first batch
  double maxDifference = 0.0;  ///< of that between the two paths
  double gflops = 0.0;         ///< six operations per parameter and frame
  double sgemmGflops = 0.0;    ///< of the machine, median over the same time
  int64_t parameters = 0;
};

/// Both paths in turn. Throws InputError for a bad configuration or for numbers below one;
/// CancelledError.
TrainBenchResult benchTrain(const TrainBenchSpec& spec, const ModelFamily& family,
                            Progress& progress);

}  // namespace marey

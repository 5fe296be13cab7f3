// Motions of one model along one path, and all that is needed to draw them again.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "task/live_rollout.h"

#include "experiment/document.h"
#include "experiment/path_choice.h"
#include "model/scorer.h"

namespace marey {

using ClipPtr = std::shared_ptr<const Clip>;

/// What a sample set is made by: the same recipe and weights give the same motions.
struct SampleRecipe {
  ExperimentSystem system;  ///< with its temperature
  ExperimentPath path;
  int samples = 1;
  uint64_t seed = 1;
  double fps = 20.0;             ///< of the document; the model must have it
  std::filesystem::path folder;  ///< relative names start there
  /// Of a steered motion, instead of the path, which only shows where it went.
  std::shared_ptr<const Steering> steering = nullptr;
  /// Along the control of every natural clip, instead of the path (sampleHeldOut in
  /// experiment/run.h).
  bool heldOut = false;

  bool operator==(const SampleRecipe&) const = default;
};
Json toJson(const SampleRecipe& recipe);
/// A recipe as a document keeps it, and back; rate and folder are the document's.
KeptSet keptSetOf(const SampleRecipe& recipe);
SampleRecipe recipeOf(const KeptSet& set, double fps, const std::filesystem::path& folder);

struct SampledMotion {
  ClipPtr clip;
  ClipScore score;  ///< with the control that it was given
};

struct SampleSet {
  SampleRecipe recipe;
  std::string modelHash;
  std::vector<RootFrame> wanted;  ///< at the model's rate
  std::vector<SampledMotion> motions;
  double framesPerSecond = 0.0;  ///< of sampling, without scoring
};

/// Called with motions as soon as they are there, in order.
using MotionSink =
    std::function<void(const std::vector<RootFrame>& wanted, std::vector<SampledMotion> motions)>;

/// What the sampler is asked for. Throws UsageError or InputError.
SampleRequest requestOf(const MotionModel& model, const SampleRecipe& recipe);

/// Draws a recipe along a path; `chunk` motions advance together at first (0: all), then twice as
/// many each time up to 64, since a large batch is faster, and are handed to `sink`, where there is
/// one. Motions do not depend on the chunk. Throws UsageError, InputError, NumericError and
/// CancelledError.
SampleSet drawSampleSet(const MotionModel& model, const SampleRecipe& recipe, Progress& progress,
                        int chunk = 0, const MotionSink& sink = {});

}  // namespace marey

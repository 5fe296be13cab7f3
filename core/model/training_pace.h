// How fast and how sharply turning the motion was that a model was trained on: kept in the
// provenance of stored models, so that a path can be judged by it without the data.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/json.h"
#include "motion/features.h"

namespace marey {

/// Values that 0.5, 5, 95 and 99.5 % of all frames stay below.
struct PaceQuantiles {
  double lowest = 0.0, low = 0.0, high = 0.0, highest = 0.0;
  bool operator==(const PaceQuantiles&) const = default;
};

struct TrainingPace {
  PaceQuantiles speedMS;   ///< of the root over the floor
  PaceQuantiles turnRadS;  ///< above 0: to the left
  bool operator==(const TrainingPace&) const = default;
};

/// Of the control of sequences, augmented ones included: a model learns those as well.
/// Throws NumericError where there is no frame.
TrainingPace trainingPace(const std::vector<FeatureSequence>& sequences, double fps);

Json toJson(const TrainingPace& pace);
/// Out of a model's provenance; none in models that were stored without it. Throws InputError
/// naming `origin` for one of another form.
std::optional<TrainingPace> trainingPaceOf(const Json& provenance, const std::string& origin);
/// Of a stored model, reading no weights. Throws FileError or InputError.
std::optional<TrainingPace> readTrainingPace(const std::filesystem::path& model);

}  // namespace marey

// How fast and how sharply turning the motion was that a model was trained on: kept in the
// provenance of stored models, so that a path can be judged by it without the data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "motion/features.h"
#include "motion/standing.h"

namespace marey {

/// Values that 0.5, 5, 95 and 99.5 % of all frames stay below.
struct PaceQuantiles {
  double lowest = 0.0, low = 0.0, high = 0.0, highest = 0.0;
  bool operator==(const PaceQuantiles&) const = default;
};

struct TrainingPace {
  PaceQuantiles speedMS;   ///< of the root over the floor
  PaceQuantiles turnRadS;  ///< above 0: to the left
  /// Share of frames slower than kStandingMS; none in models that were stored without it.
  std::optional<double> standingShare = std::nullopt;

  /// Whether it is known that hardly a frame in a thousand stands: a path that does asks for
  /// something that was never seen.
  bool lacksStanding() const { return standingShare && *standingShare < 1e-3; }
  bool operator==(const TrainingPace&) const = default;
};

/// Of the control of sequences, augmented ones included: a model learns those as well.
/// Throws NumericError where there is no frame.
TrainingPace trainingPace(const std::vector<FeatureSequence>& sequences, double fps);

/// What to say where a path stands still and the model is known to have seen no standing: a
/// sentence that names it; "" where there is nothing to say.
std::string standingWarning(const std::string& model, const std::optional<TrainingPace>& pace,
                            const std::vector<RootFrame>& path, double fps);

Json toJson(const TrainingPace& pace);
/// Out of a model's provenance; none in models that were stored without it. Throws InputError
/// naming `origin` for one of another form.
std::optional<TrainingPace> trainingPaceOf(const Json& provenance, const std::string& origin);
/// Of a stored model, reading no weights. Throws FileError or InputError.
std::optional<TrainingPace> readTrainingPace(const std::filesystem::path& model);

}  // namespace marey

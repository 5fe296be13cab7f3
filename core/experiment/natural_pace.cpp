#include "experiment/natural_pace.h"

#include "base/error.h"
#include "model/training_pace.h"

namespace marey {
namespace {

Spread spreadFrom(const PaceQuantiles& q) {
  return {.minimum = q.lowest, .low = q.low, .high = q.high, .maximum = q.highest};
}

std::optional<TrainingPace> trainedPace(const std::string& file) {
  try {
    return readTrainingPace(file);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<PaceRange> naturalPace(const std::vector<PaceModel>& models,
                                     const std::vector<std::shared_ptr<const Clip>>& clips,
                                     Progress& progress) {
  for (const PaceModel& model : models)
    if (const auto pace = trainedPace(model.file))
      return PaceRange{.speedMS = spreadFrom(pace->speedMS),
                       .turnRadS = spreadFrom(pace->turnRadS),
                       .model = model.name};
  return paceOf(clips, progress);
}

}  // namespace marey

#include "model/training_pace.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "base/tensor_metadata.h"

namespace marey {
namespace {

constexpr const char* kKey = "training_pace";

PaceQuantiles quantilesOf(std::vector<double> values) {
  if (values.empty()) throw NumericError("the pace of training data needs at least one frame");
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return sortedQuantile(values, share); };
  return {at(0.005), at(0.05), at(0.95), at(0.995)};
}

Json toJson(const PaceQuantiles& q) {
  return {q.lowest, q.low, q.high, q.highest};
}

PaceQuantiles quantilesFrom(JsonReader& reader, const std::string& key) {
  const auto values = reader.required<std::vector<double>>(key);
  if (values.size() != 4 || !std::is_sorted(values.begin(), values.end()))
    throwInput(reader.place(key), "four rising values", "{} values, or others", values.size());
  return {values[0], values[1], values[2], values[3]};
}

}  // namespace

TrainingPace trainingPace(const std::vector<FeatureSequence>& sequences, double fps) {
  std::vector<double> speeds, turns;
  for (const FeatureSequence& sequence : sequences)
    for (long t = 0; t < sequence.control.rows(); ++t) {
      speeds.push_back(std::hypot(sequence.control(t, 0), sequence.control(t, 1)) * fps);
      turns.push_back(sequence.control(t, 2) * fps);
    }
  const auto standing =
      std::count_if(speeds.begin(), speeds.end(), [](double speed) { return speed < kStandingMS; });
  const double share = static_cast<double>(standing) / static_cast<double>(speeds.size());
  return {quantilesOf(std::move(speeds)), quantilesOf(std::move(turns)), share};
}

std::string standingWarning(const std::string& model, const std::optional<TrainingPace>& pace,
                            const std::vector<RootFrame>& path, double fps) {
  const double seconds = standingSeconds(path, fps);
  if (seconds <= 0.0 || !pace || !pace->lacksStanding()) return {};
  return fmt::format(
      "the path stands still for {:.1f} s, but {} was trained on motion of which {:.1f} % of "
      "frames "
      "stand (slower than {:g} cm/s): it has hardly seen a body at rest",
      seconds, model, 100.0 * *pace->standingShare, 100.0 * kStandingMS);
}

Json toJson(const TrainingPace& pace) {
  Json out = {{"quantiles", {0.005, 0.05, 0.95, 0.995}},
              {"speed_m_s", toJson(pace.speedMS)},
              {"turn_rad_s", toJson(pace.turnRadS)}};
  if (pace.standingShare) out["standing_share"] = *pace.standingShare;
  return out;
}

std::optional<TrainingPace> trainingPaceOf(const Json& provenance, const std::string& origin) {
  if (!provenance.is_object() || !provenance.contains(kKey)) return std::nullopt;
  JsonReader reader(provenance.at(kKey), origin, std::string(kKey) + ".");
  TrainingPace out{quantilesFrom(reader, "speed_m_s"), quantilesFrom(reader, "turn_rad_s")};
  if (reader.has("standing_share")) {
    out.standingShare = reader.required<double>("standing_share");
    if (!(*out.standingShare >= 0.0 && *out.standingShare <= 1.0))
      throwInput(reader.place("standing_share"), "a share from 0 to 1", "{}", *out.standingShare);
  }
  return out;
}

std::optional<TrainingPace> readTrainingPace(const std::filesystem::path& model) {
  const Json metadata = readTensorMetadata(model);
  if (!metadata.is_object() || !metadata.contains("provenance")) return std::nullopt;
  return trainingPaceOf(metadata.at("provenance"), model.string());
}

}  // namespace marey

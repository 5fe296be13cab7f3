#include "model/likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "model/pose_units.h"

namespace marey {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kNamed = 5;  ///< short clips that a sentence names

}  // namespace

double floorDirectionsOf(const ModelInfo& info) {
  if (info.observation.none() || !info.provenance.is_object()) return kNaN;
  return info.provenance.value("floor_directions", kNaN);
}

LikelihoodSummary summarise(const ModelInfo& info, std::span<const ClipScore> scores,
                            int firstFrame) {
  LikelihoodSummary out{.firstFrame = firstFrame,
                        .nats = kNaN,
                        .linearGaussian = kNaN,
                        .floorDirections = kNaN,
                        .effectiveDimensions = kNaN,
                        .natsPerEffectiveDimension = kNaN};
  out.unit =
      scores.empty() || scores.front().unit.empty() ? likelihoodUnit(info) : scores.front().unit;
  if (info.density == DensityKind::None) return out;
  double nats = 0.0, yardstick = 0.0;
  for (const ClipScore& score : scores) {
    const long skipped = std::max(0, firstFrame - score.firstFrame);
    const auto scored = static_cast<long>(score.loglikNats.size());
    if (scored <= skipped) {
      out.tooShort.push_back({score.name, score.frames, firstFrame + 1});
      continue;
    }
    ++out.clips;
    out.frames += scored - skipped;
    for (long t = skipped; t < scored; ++t) {
      nats += score.loglikNats[static_cast<size_t>(t)];
      yardstick += score.linearGaussianNats.empty()
                       ? kNaN
                       : score.linearGaussianNats[static_cast<size_t>(t)];
    }
  }
  const auto mean = [&](double sum) {
    return out.frames > 0 ? sum / static_cast<double>(out.frames) : kNaN;
  };
  out.nats = mean(nats);
  out.linearGaussian = mean(yardstick);
  out.floorDirections = floorDirectionsOf(info);
  out.effectiveDimensions = info.poseDim - out.floorDirections;
  out.natsPerEffectiveDimension = out.nats / out.effectiveDimensions;
  return out;
}

std::string tooShortText(const LikelihoodSummary& s) {
  if (s.tooShort.empty()) return {};
  std::string names;
  for (size_t i = 0; i < std::min(kNamed, s.tooShort.size()); ++i)
    names += (i > 0 ? ", " : "") + s.tooShort[i].name;
  if (s.tooShort.size() > kNamed) names += fmt::format(" and {} more", s.tooShort.size() - kNamed);
  return fmt::format("{} of {} clips {} too short to score (fewer than {} frames): {}",
                     s.tooShort.size(), s.tooShort.size() + static_cast<size_t>(s.clips),
                     s.tooShort.size() == 1 ? "is" : "are", s.firstFrame + 1, names);
}

std::string floorText(const ModelInfo& info) {
  if (info.density == DensityKind::None) return "This model has no likelihood.";
  if (info.observation.none())
    return "No floor: the density is of poses as they are, and where bones are constant its number "
           "hangs on how constant they are.";
  const double on = floorDirectionsOf(info);
  std::string out = fmt::format("Observation floor {} ({} fixed draws).", floorSizeText(info),
                                info.observation.draws);
  if (!(std::isfinite(on) && on >= 0.5)) return out;
  out += fmt::format(" {:.0f} of {} directions lie on it", on, info.poseDim);
  // What a normal density as wide as the floor gives on average for noise of that width, cm. Where
  // values have several units, directions are mixtures of them and have no common share.
  const double each =
      -std::log(100.0 * info.observation.floorM) - 0.5 * std::log(2.0 * std::numbers::pi) - 0.5;
  if (allLengths(info)) out += fmt::format(" and supply about {:.0f} nats per frame", on * each);
  return out + ", which another floor would change: the number hangs on the floor.";
}

}  // namespace marey

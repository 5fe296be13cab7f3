// What a likelihood is of. A density over poses whose bones are constant is singular: whatever
// scale it is given there decides the number. So a clip is scored as if seen through noise of a
// stated size, the same in every direction of pose space: training adds that noise to the poses
// that are to be foreseen (dequantisation), and a score is the mean of the log-density over a few
// fixed draws of it. No direction can then gain more than noise of that size allows.
#pragma once

#include <string>

#include "base/json.h"
#include "motion/features.h"

namespace marey {

struct ObservationNoise {
  /// Standard deviation of every coordinate of every joint; of angles what floorScales
  /// (model/pose_units.h) makes of it; 0: none.
  double floorM = 0.0;
  int draws = 0;  ///< over which a score is the mean; even; 0: poses are scored as they are

  bool none() const { return draws == 0; }
  double floorMm() const { return 1e3 * floorM; }
  bool operator==(const ObservationNoise&) const = default;
};

/// Of models that are trained with a floor: two draws and their opposites.
constexpr int kObservationDraws = 4;

Json toJson(const ObservationNoise& noise);
/// Throws InputError naming `origin`.
ObservationNoise observationNoiseFromJson(const Json& value, const std::string& origin);

/// Noise [rows, width] of size floorM (of other than lengths to be scaled by floorScales) of draw
/// `draw` on frames first .. first + rows - 1 of any clip. Draws 2k and 2k + 1 are opposite, so
/// that what is odd in the noise cancels.
Matrix observationNoise(const ObservationNoise& noise, int draw, long first, long rows, long width);

}  // namespace marey

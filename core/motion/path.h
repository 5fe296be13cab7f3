// Paths on the floor that a character is asked to follow.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "motion/annotations.h"
#include "motion/features.h"

namespace marey {

/// A point of a path file. Between way-points the path is a Catmull-Rom (centripetal) spline; a
/// way-point without time is reached at the latest speed given before it (1.2 m/s where none is).
struct WayPoint {
  double x = 0.0, z = 0.0;        ///< metres
  std::optional<double> timeS;    ///< when to be there; or
  std::optional<double> speedMS;  ///< how fast to leave it
  std::optional<double> facing;   ///< heading in radians; default: along the path
  std::string type = {};          ///< label of the motion from here on; empty: as before, or none

  bool operator==(const WayPoint&) const = default;
};

/// Root frames along way-points at `fps`. Throws InputError (naming `origin`) for fewer than two
/// way-points, times that do not rise, or speeds that are not positive.
std::vector<RootFrame> samplePath(const std::vector<WayPoint>& points, double fps,
                                  const std::string& origin);

/// The labels of the stretches between way-points, in the time of samplePath's frames. Throws as
/// samplePath.
std::vector<LabelSpan> pathLabels(const std::vector<WayPoint>& points, const std::string& origin);

/// A path file: JSON {"waypoints": [{"x","z","time"|"speed","facing_deg","type"}...], "facing":
/// "path"|"fixed"}, or a table (CSV with commas, semicolons or tabs) whose first row names its
/// columns: x and z in metres, and time (seconds), speed (m/s), facing_deg, type where they are
/// known.
/// Throws FileError or InputError naming the key or line.
std::vector<WayPoint> readPathFile(const std::filesystem::path& file);
/// What of the way-points has no effect: a sentence each.
std::vector<std::string> pathRemarks(const std::vector<WayPoint>& points);
/// Throws FileError.
void writePathFile(const std::filesystem::path& file, const std::vector<WayPoint>& points);
/// The object of a path file, wherever it stands. Throws InputError naming `origin` and the key.
std::vector<WayPoint> wayPointsFromJson(const Json& value, const std::string& origin,
                                        const std::string& prefix = {});
Json toJson(const std::vector<WayPoint>& points);

struct PathPreset {
  std::string name;
  std::string description;
};
/// still, sideways, slow, fast, backward, turn-left, turn-right (the papers' synthetic control),
/// circle, figure-eight.
const std::vector<PathPreset>& pathPresets();

/// Root frames of a preset for `seconds` at `fps`, from the origin facing +Z; `scale` multiplies
/// its speed (1 for a human; 0.6 for a dog).
/// Throws UsageError naming the presets when there is none of that name.
std::vector<RootFrame> presetPath(const std::string& name, double seconds, double fps,
                                  double scale = 1.0);

}  // namespace marey

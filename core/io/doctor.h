// The import doctor: what a motion file is, with the evidence, and what is wrong with it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "io/format.h"

namespace marey::io {

enum class Severity { Note, Warning, Error };
const char* name(Severity severity);

struct Fault {
  std::string kind;  ///< "unreadable", "teleport", "spike", "frozen", "duplicate_frames",
                     ///< "swapped_sides", "below_floor", "floor_offset", "bone_drift",
                     ///< "foot_skate", "rounded_frame_time", "short_clip", "unit_uncertain",
                     ///< "up_uncertain", "repeated_name", "frame_count", "left_out",
                     ///< "calibration_pose", "rate_doubtful", "low_rate", "root_orientation"
  Severity severity = Severity::Warning;
  std::string evidence;
  std::optional<int> frame;  ///< 1-based, where it begins
};

/// A statement and what it rests on.
struct Finding {
  std::string value;
  std::string evidence;
};

struct BoneDrift {
  double maxStdM = 0.0;  ///< largest standard deviation of a bone's length over the clip
  std::string bone;      ///< "parent-child"
};

/// One clip of a file; lengths in metres after conversion.
struct DoctorReport {
  std::string path;
  std::string clip;
  std::string format;
  double fps = 0.0;
  int frames = 0;
  int joints = 0;
  double seconds = 0.0;
  Finding up;    ///< "y" or "z" of the file
  Finding unit;  ///< of the file
  double metresPerUnit = 1.0;
  std::string skeleton;                    ///< naming habit and body: "CMU biped", ...
  std::map<std::string, int> eulerOrders;  ///< order -> joints
  Finding sides;                           ///< "as named", "swapped" or "unknown"
  std::optional<double> floorM;            ///< height of the floor under the feet
  BoneDrift boneDrift;
  std::optional<double> footSkateShare;  ///< of foot-frames near the floor
  std::vector<Fault> faults;
  std::vector<std::string> notes;  ///< conversions of the reader
};

/// One report per clip. A file that cannot be read gives one report with the fault
/// "unreadable", whose evidence is the error's text.
std::vector<DoctorReport> examine(const std::filesystem::path& path,
                                  const ReadOptions& options = {});
DoctorReport examineClip(const Clip& clip);

/// The faults of a clip that every number computed from it hangs on: an uncertain unit or up axis,
/// a doubtful rate, frames or bodies that were left out, a calibration pose. Every command that
/// reads clips tells them. `clip` is as its reader gave it.
std::vector<Fault> doubtsOf(const Clip& clip);

Json toJson(const Fault& fault);
Json toJson(const DoctorReport& report);
/// A few lines for people.
std::string toText(const DoctorReport& report);

}  // namespace marey::io

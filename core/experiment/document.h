// The experiment document: what is compared with what, seeds and paths. A plain struct; the
// command line and the window run the same one and get the same numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "motion/path.h"

namespace marey {

struct ExperimentSystem {
  std::string name;   ///< shown in figures and tables
  std::string model;  ///< model file
  double temperature = 1.0;
  bool operator==(const ExperimentSystem&) const = default;
};

/// Shorter paths hold no motion to speak of.
inline constexpr double kShortestPathS = 0.2;

struct ExperimentPath {
  std::string name;
  std::string path;  ///< preset:NAME, clip:FILE or a path file; empty where way-points are given
  std::vector<WayPoint> wayPoints = {};  ///< a path drawn in the document itself
  /// 0: a preset's usual 10 s, else as long as the clip or path takes.
  double seconds = 10.0;
  bool startFromClip = false;  ///< clip:FILE only: its first frames start the motion
  bool followsClip() const { return wayPoints.empty() && path.starts_with("clip:"); }
  bool operator==(const ExperimentPath&) const = default;
};

struct Experiment {
  std::string title = "Experiment";
  std::string notes;
  /// Files, folders, @LIST, or walker:CLIPS,SECONDS,SEED for the procedural walker. A document may
  /// have none yet; running it then fails.
  std::vector<std::string> natural;
  std::vector<ExperimentSystem> systems;
  std::vector<ExperimentPath> paths;
  int samples = 8;         ///< per path
  int heldOutSamples = 1;  ///< along the control of each natural clip; 0: none
  uint64_t seed = 1;
  double fps = 20.0;
  std::string feet;  ///< joint names; empty: found by name
  double toleranceStepCmS = 1.0;
  /// Natural motion that samples along held-out control are compared with: "all", "same-control" or
  /// "same-style" (comparison.h).
  std::string against = "all";
  std::filesystem::path folder;  ///< of the document: relative names start there (not stored)
  bool operator==(const Experiment&) const = default;
};

/// Strict: unknown keys, wrong types and values out of range throw InputError naming the key.
Experiment experimentFromJson(const Json& value, const std::string& origin);
/// As experimentFromJson; the folder is the file's, as a whole name.
Experiment readExperiment(const std::filesystem::path& path);
Json toJson(const Experiment& experiment);
/// Written atomically. Throws FileError.
void writeExperiment(const std::filesystem::path& path, const Experiment& experiment);
std::string experimentHash(const Experiment& experiment);

}  // namespace marey

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

struct ExperimentPath {
  std::string name;
  std::string path;  ///< preset:NAME, clip:FILE or a path file; empty where way-points are given
  std::vector<WayPoint> wayPoints = {};  ///< a path drawn in the document itself
  double seconds = 10.0;                 ///< 0, for way-points only: as long as the path takes
  bool operator==(const ExperimentPath&) const = default;
};

struct Experiment {
  std::string title = "Experiment";
  std::string notes;
  /// Files, folders, @LIST, or walker:CLIPS,SECONDS,SEED for the procedural walker.
  std::vector<std::string> natural;
  std::vector<ExperimentSystem> systems;
  std::vector<ExperimentPath> paths;
  int samples = 8;         ///< per path
  int heldOutSamples = 1;  ///< along the control of each natural clip; 0: none
  uint64_t seed = 1;
  double fps = 20.0;
  std::string feet;  ///< joint names; empty: found by name
  double toleranceStepCmS = 1.0;
  std::filesystem::path folder;  ///< of the document: relative names start there (not stored)
  bool operator==(const Experiment&) const = default;
};

/// Strict: unknown keys, wrong types and empty lists throw InputError naming the key.
Experiment experimentFromJson(const Json& value, const std::string& origin);
Experiment readExperiment(const std::filesystem::path& path);
Json toJson(const Experiment& experiment);
/// Written atomically. Throws FileError.
void writeExperiment(const std::filesystem::path& path, const Experiment& experiment);
std::string experimentHash(const Experiment& experiment);

}  // namespace marey

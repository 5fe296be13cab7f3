// The experiment document: what is compared with what, seeds and paths. A plain struct; the
// command line and the window run the same one and get the same numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "experiment/experiment_case.h"
#include "experiment/parts.h"
#include "experiment/view_state.h"

namespace marey {

/// Of documents; those without the key are of version 1.
inline constexpr int kExperimentVersion = 1;

struct Experiment {
  std::string title = "Experiment";
  std::string notes;
  /// Files, folders, @LIST, or walker:CLIPS,SECONDS,SEED for the procedural walker. A document may
  /// have none yet; running it then fails.
  std::vector<std::string> natural;
  /// Names of natural clips that statistics, scores and samples leave out.
  std::vector<std::string> naturalLeftOut;
  std::vector<ExperimentSystem> systems;
  std::vector<ExperimentPath> paths;
  std::vector<ExperimentCase> cases;  ///< tasks on the natural clips
  int samples = 8;                    ///< per path
  int heldOutSamples = 1;             ///< along the control of each natural clip; 0: none
  uint64_t seed = 1;
  double fps = 20.0;
  std::string feet;  ///< joint names; empty: found by name
  double toleranceStepCmS = 1.0;
  /// Natural motion that samples along held-out control are compared with: "all", "same-control" or
  /// "same-style" (comparison.h).
  std::string against = "all";
  std::filesystem::path folder;  ///< of the document: relative names start there (not stored)
  /// How it was looked at last. Decides no number: it is no part of equality or hash.
  ViewState view = {};
  bool operator==(const Experiment& other) const;
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

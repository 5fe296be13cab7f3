// What an experiment is made of: systems (models with their settings) and paths.
#pragma once

#include <string>
#include <vector>

#include "base/json_lists.h"
#include "experiment/control_choice.h"
#include "model/sampling_option.h"
#include "motion/path.h"

namespace marey {

struct ExperimentSystem {
  std::string name;   ///< shown in figures and tables
  std::string model;  ///< model file
  double temperature = 1.0;
  OptionValues options = {};  ///< of the model's optionSchema, beside the temperature
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
  ControlChoice control = {};
  bool followsClip() const { return wayPoints.empty() && path.starts_with("clip:"); }
  bool operator==(const ExperimentPath&) const = default;
};

/// Strict: unknown keys, wrong types and values out of range throw InputError naming `prefix` and
/// the key.
ExperimentSystem systemFromJson(const Json& value, const std::string& origin,
                                const std::string& prefix);
ExperimentPath pathFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix);
Json toJson(const ExperimentSystem& system);
Json toJson(const ExperimentPath& path);

}  // namespace marey

// What an experiment is made of: systems (models with their settings) and paths.
#pragma once

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

/// Strict: unknown keys, wrong types and values out of range throw InputError naming `prefix` and
/// the key.
ExperimentSystem systemFromJson(const Json& value, const std::string& origin,
                                const std::string& prefix);
ExperimentPath pathFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix);
Json toJson(const ExperimentSystem& system);
Json toJson(const ExperimentPath& path);

/// Throws InputError naming the key unless value >= least.
template <typename T>
void requireAtLeast(const JsonReader& reader, const char* key, T value, T least) {
  if (!(value >= least))
    throwInput(reader.place(key), fmt::format("at least {}", least), "{}", value);
}

/// What `parse` makes of every item of a list; nothing where there is no such key.
template <typename T>
std::vector<T> listFrom(JsonReader& reader, const std::string& key,
                        T (*parse)(const Json&, const std::string&, const std::string&),
                        const std::string& prefix = {}) {
  std::vector<T> out;
  if (!reader.has(key)) return out;
  const Json& list = reader.raw(key);
  if (!list.is_array()) throw InputError(reader.place(key), "a list", list.type_name());
  for (size_t i = 0; i < list.size(); ++i)
    out.push_back(parse(list[i], reader.origin(), fmt::format("{}{}[{}].", prefix, key, i)));
  return out;
}

}  // namespace marey

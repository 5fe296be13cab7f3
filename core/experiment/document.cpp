#include "experiment/document.h"

#include <set>

#include "base/hash.h"
#include "experiment/comparison.h"

namespace marey {
namespace {

template <typename T>
void requireAtLeast(const JsonReader& reader, const char* key, T value, T least) {
  if (!(value >= least))
    throwInput(reader.place(key), fmt::format("at least {}", least), "{}", value);
}

ExperimentSystem systemFromJson(const Json& value, const std::string& origin,
                                const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ExperimentSystem out;
  out.name = reader.required<std::string>("name");
  out.model = reader.required<std::string>("model");
  out.temperature = reader.optional("temperature", out.temperature);
  reader.finish();
  requireAtLeast(reader, "temperature", out.temperature, 0.0);
  return out;
}

ExperimentPath pathFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ExperimentPath out;
  out.name = reader.required<std::string>("name");
  if (reader.has("waypoints")) {
    out.wayPoints = wayPointsFromJson({{"waypoints", reader.raw("waypoints")}}, origin, prefix);
    out.seconds = reader.optional("seconds", 0.0);
    if (reader.has("path"))
      throw InputError(reader.place("path"), "either a path or way-points", "both");
    if (out.wayPoints.size() < 2)
      throwInput(reader.place("waypoints"), "at least two", "{}", out.wayPoints.size());
  } else {
    out.path = reader.required<std::string>("path");
    out.seconds = reader.optional("seconds", out.seconds);
  }
  const auto start = reader.optional<std::string>("start", "mean");
  reader.finish();
  if (start != "mean" && start != "clip")
    throw InputError(reader.place("start"), "'mean' or 'clip'", "'" + start + "'");
  out.startFromClip = start == "clip";
  if (out.startFromClip && !out.followsClip())
    throw InputError(reader.place("start"), "'mean' for a path that is no clip:FILE", "'clip'");
  if (out.seconds != 0.0) requireAtLeast(reader, "seconds", out.seconds, kShortestPathS);
  return out;
}

/// The objects of a list, whose names must differ: figures and tables are keyed by them.
template <typename T>
std::vector<T> namedList(JsonReader& reader, const std::string& key,
                         T (*parse)(const Json&, const std::string&, const std::string&)) {
  std::vector<T> out;
  if (!reader.has(key)) return out;
  const Json& list = reader.raw(key);
  if (!list.is_array()) throw InputError(reader.place(key), "a list", list.type_name());
  std::set<std::string> names;
  for (size_t i = 0; i < list.size(); ++i) {
    out.push_back(parse(list[i], reader.origin(), fmt::format("{}[{}].", key, i)));
    if (!names.insert(out.back().name).second)
      throw InputError(reader.place(key), "different names", "'" + out.back().name + "' twice");
  }
  return out;
}

std::string againstFrom(JsonReader& reader, const std::string& fallback) {
  const auto name = reader.optional("against", fallback);
  try {
    naturalChoiceByName(name);
  } catch (const UsageError&) {
    throw InputError(reader.place("against"), "all, same-control or same-style", "'" + name + "'");
  }
  return name;
}

}  // namespace

Experiment experimentFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin);
  Experiment out;
  out.title = reader.optional("title", out.title);
  out.notes = reader.optional("notes", out.notes);
  out.natural = reader.required<std::vector<std::string>>("natural");
  out.systems = namedList(reader, "systems", systemFromJson);
  out.paths = namedList(reader, "paths", pathFromJson);
  out.samples = reader.optional("samples", out.samples);
  out.heldOutSamples = reader.optional("held_out_samples", out.heldOutSamples);
  out.seed = reader.optional("seed", out.seed);
  out.fps = reader.optional("fps", out.fps);
  out.feet = reader.optional("feet", out.feet);
  out.toleranceStepCmS = reader.optional("tolerance_step_cm_s", out.toleranceStepCmS);
  out.against = againstFrom(reader, out.against);
  reader.finish();
  requireAtLeast(reader, "samples", out.samples, 1);
  requireAtLeast(reader, "held_out_samples", out.heldOutSamples, 0);
  requireAtLeast(reader, "fps", out.fps, 1.0);
  requireAtLeast(reader, "tolerance_step_cm_s", out.toleranceStepCmS, 0.01);
  return out;
}

Experiment readExperiment(const std::filesystem::path& path) {
  Experiment out = experimentFromJson(readJson(path), path.string());
  // Whole, so that names keep their meaning where the working folder changes.
  std::error_code none;
  const auto whole = std::filesystem::absolute(path, none);
  out.folder = (none ? path : whole).parent_path();
  return out;
}

Json toJson(const Experiment& e) {
  Json systems = Json::array(), paths = Json::array();
  for (const auto& s : e.systems)
    systems.push_back({{"name", s.name}, {"model", s.model}, {"temperature", s.temperature}});
  for (const auto& p : e.paths) {
    Json one = p.wayPoints.empty() ? Json{{"path", p.path}} : toJson(p.wayPoints);
    one["name"] = p.name;
    one["seconds"] = p.seconds;
    if (p.startFromClip) one["start"] = "clip";
    paths.push_back(one);
  }
  Json out = {{"title", e.title},
              {"notes", e.notes},
              {"natural", e.natural},
              {"systems", systems},
              {"paths", paths},
              {"samples", e.samples},
              {"held_out_samples", e.heldOutSamples},
              {"seed", e.seed},
              {"fps", e.fps},
              {"feet", e.feet},
              {"tolerance_step_cm_s", e.toleranceStepCmS}};
  if (e.against != Experiment().against) out["against"] = e.against;
  return out;
}

void writeExperiment(const std::filesystem::path& path, const Experiment& experiment) {
  writeJson(path, toJson(experiment));
}

std::string experimentHash(const Experiment& experiment) {
  return contentHash(jsonText(toJson(experiment)));
}

}  // namespace marey

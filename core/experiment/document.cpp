#include "experiment/document.h"

#include <set>
#include <tuple>

#include "base/format_version.h"
#include "base/hash.h"
#include "experiment/comparison.h"

namespace marey {
namespace {

/// The objects of a list, whose names must differ: figures and tables are keyed by them.
template <typename T>
std::vector<T> namedList(JsonReader& reader, const std::string& key,
                         T (*parse)(const Json&, const std::string&, const std::string&)) {
  std::vector<T> out = listFrom(reader, key, parse);
  std::set<std::string> names;
  for (const T& item : out)
    if (!names.insert(item.name).second)
      throw InputError(reader.place(key), "different names", "'" + item.name + "' twice");
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
  readFormatVersion(reader, kExperimentVersion);
  Experiment out;
  out.title = reader.optional("title", out.title);
  out.notes = reader.optional("notes", out.notes);
  out.natural = reader.required<std::vector<std::string>>("natural");
  out.naturalLeftOut = reader.optional("natural_left_out", out.naturalLeftOut);
  out.systems = namedList(reader, "systems", systemFromJson);
  out.paths = namedList(reader, "paths", pathFromJson);
  out.cases = namedList(reader, "cases", caseFromJson);
  out.samples = reader.optional("samples", out.samples);
  out.heldOutSamples = reader.optional("held_out_samples", out.heldOutSamples);
  out.seed = reader.optional("seed", out.seed);
  out.fps = reader.optional("fps", out.fps);
  out.feet = reader.optional("feet", out.feet);
  out.toleranceStepCmS = reader.optional("tolerance_step_cm_s", out.toleranceStepCmS);
  out.against = againstFrom(reader, out.against);
  if (reader.has("view")) out.view = viewStateFromJson(reader.raw("view"), origin, "view.");
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

namespace {

/// All that decides a number.
Json withoutView(const Experiment& e) {
  Json systems = Json::array(), paths = Json::array();
  for (const auto& s : e.systems) systems.push_back(toJson(s));
  for (const auto& p : e.paths) paths.push_back(toJson(p));
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
  for (const ExperimentCase& one : e.cases) out["cases"].push_back(toJson(one));
  if (e.against != Experiment().against) out["against"] = e.against;
  // Documents that leave nothing out keep the hash that they had.
  if (!e.naturalLeftOut.empty()) out["natural_left_out"] = e.naturalLeftOut;
  return out;
}

}  // namespace

bool Experiment::operator==(const Experiment& other) const {
  const auto key = [](const Experiment& e) {
    return std::tie(e.title, e.notes, e.natural, e.naturalLeftOut, e.systems, e.paths, e.cases,
                    e.samples, e.heldOutSamples, e.seed, e.fps, e.feet, e.toleranceStepCmS,
                    e.against, e.folder);
  };
  return key(*this) == key(other);
}

Json toJson(const Experiment& e) {
  Json out = {{"version", kExperimentVersion}};
  out.update(withoutView(e));
  if (Json view = toJson(e.view); !view.empty()) out["view"] = std::move(view);
  return out;
}

void writeExperiment(const std::filesystem::path& path, const Experiment& experiment) {
  writeJson(path, toJson(experiment));
}

std::string experimentHash(const Experiment& experiment) {
  return contentHash(jsonText(withoutView(experiment)));
}

}  // namespace marey

#include "experiment/parts.h"

namespace marey {

namespace {

OptionValues optionsFrom(const Json& value, JsonReader reader) {
  OptionValues out;
  for (const auto& [name, number] : value.items()) out[name] = reader.required<double>(name);
  if (out.contains("temperature"))
    throw InputError(reader.place("temperature"), "the temperature beside 'options'", "in them");
  return out;
}

}  // namespace

ExperimentSystem systemFromJson(const Json& value, const std::string& origin,
                                const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ExperimentSystem out;
  out.name = reader.required<std::string>("name");
  out.model = reader.required<std::string>("model");
  out.temperature = reader.optional("temperature", out.temperature);
  if (reader.has("options"))
    out.options = optionsFrom(reader.raw("options"), reader.object("options"));
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
  out.control = controlChoiceFrom(reader);
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

Json toJson(const ExperimentSystem& system) {
  Json out = {{"name", system.name}, {"model", system.model}, {"temperature", system.temperature}};
  // Documents without any keep the hash that they had.
  if (!system.options.empty()) out["options"] = system.options;
  return out;
}

Json toJson(const ExperimentPath& path) {
  Json out = path.wayPoints.empty() ? Json{{"path", path.path}} : toJson(path.wayPoints);
  out["name"] = path.name;
  out["seconds"] = path.seconds;
  if (path.startFromClip) out["start"] = "clip";
  addTo(out, path.control);
  return out;
}

}  // namespace marey

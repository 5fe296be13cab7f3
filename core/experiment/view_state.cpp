#include "experiment/view_state.h"

#include <algorithm>

namespace marey {
namespace {

constexpr int kCameraSlots = 9;

/// The index of a name in a list; the error names all of them.
template <size_t N>
int namedIndex(JsonReader& reader, const char* key, const std::array<const char*, N>& names,
               int fallback) {
  if (!reader.has(key)) return fallback;
  const auto name = reader.required<std::string>(key);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throwInput(reader.place(key), fmt::format("one of {}", fmt::join(names, ", ")), "'{}'", name);
  return static_cast<int>(found - names.begin());
}

std::array<double, 3> point(JsonReader& reader, const char* key) {
  const auto values = reader.required<std::vector<double>>(key);
  if (values.size() != 3) throwInput(reader.place(key), "3 numbers", "{}", values.size());
  return {values[0], values[1], values[2]};
}

CameraPose cameraFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  CameraPose out{.eye = point(reader, "eye"),
                 .target = point(reader, "target"),
                 .up = point(reader, "up"),
                 .heightM = reader.required<double>("height_m"),
                 .orthographic = reader.optional("orthographic", false)};
  reader.finish();
  requireAtLeast(reader, "height_m", out.heightM, 1e-3);
  if (out.eye == out.target)
    throw InputError(reader.place("target"), "a point away from the eye", "the same point");
  return out;
}

Json toJson(const CameraPose& c) {
  return {{"eye", c.eye},
          {"target", c.target},
          {"up", c.up},
          {"height_m", c.heightM},
          {"orthographic", c.orthographic}};
}

SceneLook lookFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  SceneLook out;
  out.colourBy = namedIndex(reader, "colour_by", kColourNames, out.colourBy);
  out.placement = namedIndex(reader, "placement", kPlacementNames, out.placement);
  out.detail = namedIndex(reader, "detail", kDetailNames, out.detail);
  out.trails = namedIndex(reader, "trails", kTrailNames, out.trails);
  out.opacity = reader.optional("opacity", out.opacity);
  out.ghostsS = reader.optional("ghosts_s", out.ghostsS);
  out.ghostFrames = reader.optional("ghost_frames", out.ghostFrames);
  out.trailS = reader.optional("trail_s", out.trailS);
  out.naturalUnder = reader.optional("natural_under", out.naturalUnder);
  out.contacts = reader.optional("contacts", out.contacts);
  out.shadow = reader.optional("shadow", out.shadow);
  out.path = reader.optional("path", out.path);
  reader.finish();
  requireAtLeast(reader, "ghosts_s", out.ghostsS, 0.0);
  requireAtLeast(reader, "ghost_frames", out.ghostFrames, 0);
  requireAtLeast(reader, "trail_s", out.trailS, 0.0);
  return out;
}

Json toJson(const SceneLook& s) {
  return {{"colour_by", kColourNames.at(static_cast<size_t>(s.colourBy))},
          {"placement", kPlacementNames.at(static_cast<size_t>(s.placement))},
          {"detail", kDetailNames.at(static_cast<size_t>(s.detail))},
          {"trails", kTrailNames.at(static_cast<size_t>(s.trails))},
          {"opacity", s.opacity},
          {"ghosts_s", s.ghostsS},
          {"ghost_frames", s.ghostFrames},
          {"trail_s", s.trailS},
          {"natural_under", s.naturalUnder},
          {"contacts", s.contacts},
          {"shadow", s.shadow},
          {"path", s.path}};
}

Json toJson(const ShownClips& shown) {
  return {{"source", shown.source}, {"clips", shown.clips}};
}

ShownClips shownFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ShownClips out{.source = reader.required<std::string>("source"),
                 .clips = reader.required<std::vector<int>>("clips")};
  reader.finish();
  return out;
}

KeptSet setFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  KeptSet out;
  out.system = systemFromJson(reader.raw("system"), origin, prefix + "system.");
  out.path = pathFromJson(reader.raw("path"), origin, prefix + "path.");
  out.samples = reader.optional("samples", out.samples);
  out.seed = reader.optional("seed", out.seed);
  if (reader.has("steering"))
    out.steering = steeringFromJson(reader.raw("steering"), origin, prefix + "steering.");
  out.heldOut = reader.optional("held_out", out.heldOut);
  out.pinned = reader.optional("pinned", out.pinned);
  out.colour = reader.optional("colour", out.colour);
  out.hidden = reader.optional("hidden", out.hidden);
  out.leftOut = reader.optional("left_out", out.leftOut);
  reader.finish();
  requireAtLeast(reader, "samples", out.samples, 1);
  requireAtLeast(reader, "colour", out.colour, 0);
  return out;
}

std::map<int, CameraPose> slotsFromJson(JsonReader& reader, const std::string& prefix) {
  std::map<int, CameraPose> out;
  if (!reader.has("cameras")) return out;
  const Json& slots = reader.raw("cameras");
  if (!slots.is_object()) throw InputError(reader.place("cameras"), "an object", slots.type_name());
  for (const auto& [name, camera] : slots.items()) {
    if (name.size() != 1 || name < "1" || name > std::to_string(kCameraSlots))
      throwInput(reader.place("cameras"), fmt::format("slots 1 to {}", kCameraSlots), "'{}'", name);
    out[name[0] - '0'] = cameraFromJson(camera, reader.origin(), prefix + "cameras." + name + ".");
  }
  return out;
}

template <typename Items>
Json listOf(const Items& items) {
  Json out = Json::array();
  for (const auto& item : items) out.push_back(toJson(item));
  return out;
}

}  // namespace

Json toJson(const KeptSet& set) {
  Json out = {{"system", toJson(set.system)},
              {"path", toJson(set.path)},
              {"samples", set.samples},
              {"seed", set.seed}};
  if (set.steering) out["steering"] = toJson(*set.steering);
  if (set.heldOut) out["held_out"] = true;
  if (set.pinned) out["pinned"] = true;
  if (set.colour > 0) out["colour"] = set.colour;
  if (!set.hidden.empty()) out["hidden"] = set.hidden;
  if (!set.leftOut.empty()) out["left_out"] = set.leftOut;
  return out;
}

ViewState viewStateFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ViewState out;
  out.path = reader.optional("path", out.path);
  out.notSampled = reader.optional("not_sampled", out.notSampled);
  if (reader.has("natural")) out.natural = listFrom(reader, "natural", shownFromJson, prefix);
  static constexpr std::array kComparisons{"this_path", "held_out"};
  out.comparison = static_cast<Comparison>(namedIndex(reader, "compare", kComparisons, 0));
  if (reader.has("scene")) out.scene = lookFromJson(reader.raw("scene"), origin, prefix + "scene.");
  if (reader.has("camera"))
    out.camera = cameraFromJson(reader.raw("camera"), origin, prefix + "camera.");
  out.follow = reader.optional("follow", out.follow);
  out.cameras = slotsFromJson(reader, prefix);
  out.trainingRun = reader.optional("training_run", out.trainingRun);
  out.sets = listFrom(reader, "sets", setFromJson, prefix);
  reader.finish();
  return out;
}

Json toJson(const ViewState& view) {
  Json out = Json::object();
  if (!view.path.empty()) out["path"] = view.path;
  if (!view.notSampled.empty()) out["not_sampled"] = view.notSampled;
  if (view.natural) out["natural"] = listOf(*view.natural);
  if (view.comparison == Comparison::HeldOut) out["compare"] = "held_out";
  if (view.scene != SceneLook{}) out["scene"] = toJson(view.scene);
  if (view.camera) out["camera"] = toJson(*view.camera);
  if (view.follow) out["follow"] = true;
  for (const auto& [slot, camera] : view.cameras)
    out["cameras"][std::to_string(slot)] = toJson(camera);
  if (!view.trainingRun.empty()) out["training_run"] = view.trainingRun;
  if (!view.sets.empty()) out["sets"] = listOf(view.sets);
  return out;
}

}  // namespace marey

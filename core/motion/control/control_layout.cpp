#include "motion/control/control_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace marey {
namespace {

constexpr std::array kKinds{ControlKind::RootMotion, ControlKind::FuturePath, ControlKind::Label,
                            ControlKind::Skeleton, ControlKind::Array};

int valuesOf(const ControlChannel& c, double fps) {
  const auto values = static_cast<int>(c.values.size());
  switch (c.kind) {
    case ControlKind::RootMotion:
      return 3;
    case ControlKind::FuturePath:
      return 2 * static_cast<int>(c.aheadS.size());
    case ControlKind::Label:
      return values;
    case ControlKind::Skeleton:
      return 3 * c.joints + 1;
    case ControlKind::Array:
      return values * (pastFrames(c, fps) + 1 + futureFrames(c, fps));
  }
  return 0;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void requireDistinct(const std::vector<std::string>& values, const Place& place) {
  std::set<std::string> seen;
  for (const std::string& value : values)
    if (value.empty() || !seen.insert(value).second)
      throw InputError(place, "names that differ", "'" + value + "'");
}

void validateChannel(const ControlChannel& c, const Place& place) {
  const auto need = [&](bool holds, const char* what, const std::string& found) {
    if (!holds) throw InputError(place, what, found);
  };
  switch (c.kind) {
    case ControlKind::RootMotion:
      return need(!c.optional, "root motion, which cannot be left out", "one that may be");
    case ControlKind::FuturePath:
      need(!c.aheadS.empty(), "seconds ahead of its points", "none");
      for (const double ahead : c.aheadS)
        need(ahead > 0.0 && ahead <= 60.0, "points up to 60 s ahead", fmt::format("{} s", ahead));
      return;
    case ControlKind::Label:
      need(c.values.size() >= 2, "at least two labels", fmt::format("{}", c.values.size()));
      need(c.transitionS >= 0.0 && std::isfinite(c.transitionS), "a transition of zero or more",
           fmt::format("{} s", c.transitionS));
      return requireDistinct(c.values, place);
    case ControlKind::Skeleton:
      return need(c.joints > 0, "a number of joints", fmt::format("{}", c.joints));
    case ControlKind::Array:
      need(!c.values.empty(), "at least one column", "none");
      for (const double seconds : {c.pastS, c.futureS})
        need(seconds >= 0.0 && seconds <= 60.0, "0 to 60 s of past and future",
             fmt::format("{} s", seconds));
      need(c.fps >= 0.0, "a positive rate", fmt::format("{}", c.fps));
      return requireDistinct(c.values, place);
  }
}

Place placeOf(const std::string& origin, const ControlChannel& channel) {
  return {.path = origin, .item = "control channel '" + channel.name + "'"};
}

ControlChannel channelFromJson(const Json& value, const std::string& origin, size_t index) {
  JsonReader reader(value, origin, fmt::format("control[{}].", index));
  ControlChannel out;
  out.name = reader.required<std::string>("name");
  const auto kind = reader.required<std::string>("kind");
  const auto* found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](ControlKind k) { return nameOf(k) == kind; });
  if (found == kKinds.end())
    throw InputError(reader.place("kind"), "root_motion, future_path, label, skeleton or array",
                     "'" + kind + "'");
  out.kind = *found;
  out.optional = reader.optional("optional", false);
  if (out.kind == ControlKind::FuturePath)
    out.aheadS = reader.required<std::vector<double>>("ahead_s");
  if (out.kind == ControlKind::Label) {
    out.values = reader.required<std::vector<std::string>>("labels");
    out.transitionS = reader.optional("transition_s", out.transitionS);
    out.fromNames = reader.optional("from_names", false);
  }
  if (out.kind == ControlKind::Skeleton) out.joints = reader.required<int>("joints");
  if (out.kind == ControlKind::Array) {
    out.values = reader.required<std::vector<std::string>>("columns");
    out.fps = reader.optional("fps", 0.0);
    out.pastS = reader.optional("past_s", 0.0);
    out.futureS = reader.optional("future_s", 0.0);
  }
  reader.finish();
  return out;
}

Json toJson(const ControlChannel& c) {
  Json out = {{"name", c.name}, {"kind", nameOf(c.kind)}};
  if (c.optional) out["optional"] = true;
  if (c.kind == ControlKind::FuturePath) out["ahead_s"] = c.aheadS;
  if (c.kind == ControlKind::Label) {
    out["labels"] = c.values;
    out["transition_s"] = c.transitionS;
    if (c.fromNames) out["from_names"] = true;
  }
  if (c.kind == ControlKind::Skeleton) out["joints"] = c.joints;
  if (c.kind == ControlKind::Array) {
    out["columns"] = c.values;
    if (c.fps > 0.0) out["fps"] = c.fps;
    out["past_s"] = c.pastS;
    out["future_s"] = c.futureS;
  }
  return out;
}

std::string summaryOf(const ControlChannel& c) {
  std::string out;
  switch (c.kind) {
    case ControlKind::RootMotion:
      return "root motion";
    case ControlKind::FuturePath:
      out = fmt::format("{}: {} ground points up to {:g} s ahead", c.name, c.aheadS.size(),
                        *std::max_element(c.aheadS.begin(), c.aheadS.end()));
      break;
    case ControlKind::Label:
      out = fmt::format("{}: one of {}", c.name, joined(c.values));
      break;
    case ControlKind::Skeleton:
      out = fmt::format("{}: the rest pose of {} joints", c.name, c.joints);
      break;
    case ControlKind::Array:
      out = fmt::format("{}: a signal of {} value{}", c.name, c.values.size(),
                        c.values.size() == 1 ? "" : "s");
      if (c.pastS > 0.0) out += fmt::format(", {:g} s back", c.pastS);
      if (c.futureS > 0.0) out += fmt::format(", {:g} s ahead", c.futureS);
      break;
  }
  return out + (c.optional ? " (may be left out)" : "");
}

}  // namespace

std::string nameOf(ControlKind kind) {
  switch (kind) {
    case ControlKind::RootMotion:
      return "root_motion";
    case ControlKind::FuturePath:
      return "future_path";
    case ControlKind::Label:
      return "label";
    case ControlKind::Skeleton:
      return "skeleton";
    case ControlKind::Array:
      return "array";
  }
  return {};
}

int pastFrames(const ControlChannel& channel, double fps) {
  return static_cast<int>(std::lround(channel.pastS * fps));
}

int futureFrames(const ControlChannel& channel, double fps) {
  return static_cast<int>(std::lround(channel.futureS * fps));
}

std::vector<ControlColumns> columnsOf(const ControlLayout& layout, double fps) {
  std::vector<ControlColumns> out;
  int at = 0;
  for (const ControlChannel& channel : layout) {
    ControlColumns columns{&channel, at, valuesOf(channel, fps), -1};
    if (channel.optional) columns.presence = at + columns.width;
    at = columns.end();
    out.push_back(columns);
  }
  return out;
}

int widthOf(const ControlLayout& layout, double fps) {
  return layout.empty() ? 0 : columnsOf(layout, fps).back().end();
}

const ControlChannel* channelNamed(const ControlLayout& layout, const std::string& name) {
  const auto found = std::find_if(layout.begin(), layout.end(),
                                  [&](const ControlChannel& c) { return c.name == name; });
  return found == layout.end() ? nullptr : &*found;
}

const ControlChannel* channelOf(const ControlLayout& layout, ControlKind kind) {
  const auto found = std::find_if(layout.begin(), layout.end(),
                                  [&](const ControlChannel& c) { return c.kind == kind; });
  return found == layout.end() ? nullptr : &*found;
}

bool isRootMotionAlone(const ControlLayout& layout) {
  return layout.size() == 1 && layout.front().kind == ControlKind::RootMotion;
}

void validate(const ControlLayout& layout, const std::string& origin) {
  if (layout.empty() || layout.front().kind != ControlKind::RootMotion)
    throw InputError({.path = origin, .item = "control"}, "root motion as the first channel",
                     layout.empty() ? "no channel" : "'" + layout.front().name + "'");
  std::set<std::string> names;
  std::set<ControlKind> kinds;
  for (const ControlChannel& channel : layout) {
    const Place place = placeOf(origin, channel);
    if (channel.name.empty() || !names.insert(channel.name).second)
      throw InputError(place, "names that differ", "'" + channel.name + "'");
    if (channel.kind != ControlKind::Array && !kinds.insert(channel.kind).second)
      throw InputError(place, "one channel of kind " + nameOf(channel.kind), "two");
    validateChannel(channel, place);
  }
}

Json toJson(const ControlLayout& layout) {
  Json out = Json::array();
  for (const ControlChannel& channel : layout) out.push_back(toJson(channel));
  return out;
}

ControlLayout controlLayoutFromJson(const Json& value, const std::string& origin) {
  if (!value.is_array())
    throw InputError({.path = origin, .item = "key 'control'"}, "a list", value.type_name());
  ControlLayout out;
  for (size_t i = 0; i < value.size(); ++i) out.push_back(channelFromJson(value[i], origin, i));
  validate(out, origin);
  return out;
}

std::string summaryOf(const ControlLayout& layout) {
  std::string out;
  for (const ControlChannel& channel : layout)
    out += (out.empty() ? "" : "; ") + summaryOf(channel);
  return out;
}

}  // namespace marey

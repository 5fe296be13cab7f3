#include "task/steering.h"

#include <algorithm>

#include "base/json_lists.h"

namespace marey {
namespace {

/// Ten hours at 100 frames per second: beyond it a file is damaged rather than long.
constexpr int kMostFrames = 3600000;

Json toJson(const LiveCommand& c) {
  Json out = {{"forward_m_s", c.forwardMS},
              {"sideways_m_s", c.sidewaysMS},
              {"turn_rad_s", c.turnRadS},
              {"facing_rad", c.facingRad}};
  if (!c.type.empty()) out["type"] = c.type;
  return out;
}

LiveCommand commandFrom(JsonReader& reader) {
  return {.forwardMS = reader.required<double>("forward_m_s"),
          .sidewaysMS = reader.required<double>("sideways_m_s"),
          .turnRadS = reader.required<double>("turn_rad_s"),
          .facingRad = reader.required<double>("facing_rad"),
          .type = reader.optional<std::string>("type", "")};
}

struct Run {
  int frames = 0;
  LiveCommand command;
};

Run runFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  Run out{.frames = reader.required<int>("frames"), .command = commandFrom(reader)};
  reader.finish();
  requireAtLeast(reader, "frames", out.frames, 1);
  return out;
}

}  // namespace

Json toJson(const Steering& s) {
  Json commands = Json::array();
  for (size_t i = 0; i < s.commands.size();) {
    const auto begin = s.commands.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end =
        std::find_if(begin, s.commands.end(), [&](const auto& c) { return c != *begin; });
    Json run = {{"frames", end - begin}};
    run.update(toJson(*begin));
    commands.push_back(std::move(run));
    i += static_cast<size_t>(end - begin);
  }
  const RootFrame& start = s.options.start;
  Json out = {{"warm_up_s", s.options.warmUpS},
              {"smoothing_s", s.options.smoothingS},
              {"sample", s.options.sample},
              {"begin", toJson(s.options.begin)},
              {"start", {{"x", start.x}, {"z", start.z}, {"heading_rad", start.heading}}},
              {"commands", commands}};
  if (!s.options.leftOut.empty()) out["left_out"] = s.options.leftOut;
  return out;
}

Steering steeringFromJson(const Json& value, const std::string& origin, const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  Steering out;
  out.options.warmUpS = reader.required<double>("warm_up_s");
  out.options.smoothingS = reader.required<double>("smoothing_s");
  out.options.sample = reader.required<int>("sample");
  out.options.leftOut = reader.optional("left_out", out.options.leftOut);
  JsonReader begin(reader.raw("begin"), origin, prefix + "begin.");
  out.options.begin = commandFrom(begin);
  begin.finish();
  JsonReader start(reader.raw("start"), origin, prefix + "start.");
  out.options.start = {.x = start.required<double>("x"),
                       .z = start.required<double>("z"),
                       .heading = start.required<double>("heading_rad")};
  start.finish();
  for (const Run& run : listFrom(reader, "commands", runFromJson, prefix)) {
    if (run.frames > kMostFrames - static_cast<int>(out.commands.size()))
      throwInput(reader.place("commands"), fmt::format("at most {} frames", kMostFrames), "more");
    out.commands.insert(out.commands.end(), static_cast<size_t>(run.frames), run.command);
  }
  reader.finish();
  requireAtLeast(reader, "warm_up_s", out.options.warmUpS, 0.0);
  requireAtLeast(reader, "smoothing_s", out.options.smoothingS, 0.0);
  requireAtLeast(reader, "sample", out.options.sample, 0);
  if (out.commands.empty()) throw InputError(reader.place("commands"), "at least one", "none");
  return out;
}

}  // namespace marey

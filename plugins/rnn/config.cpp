#include "rnn/config.h"

namespace marey::rnn {
namespace {

void requireRange(const JsonReader& reader, const char* key, int value, int low, int high) {
  if (value < low || value > high)
    throwInput(reader.place(key), fmt::format("a value from {} to {}", low, high), "{}", value);
}

}  // namespace

int64_t Config::parameters() const {
  const int64_t gates = cell == "lstm" ? 4 : 3, h = hidden;
  int64_t out = int64_t{poseDim} * (h + 1);
  for (int layer = 0; layer < layers; ++layer)
    out += gates * h * ((layer == 0 ? inputs() : h) + h + 2);
  return out;
}

Config configFromJson(const Json& value, const std::string& origin) {
  if (value.is_object() && value.contains("model")) return configFromJson(value["model"], origin);
  JsonReader reader(value, origin, "model.");
  Config c;
  c.poseDim = reader.optional("pose_dim", c.poseDim);
  c.controlDim = reader.optional("control_dim", c.controlDim);
  c.past = reader.optional("past", c.past);
  c.lookahead = reader.optional("lookahead", c.lookahead);
  c.hidden = reader.optional("hidden", c.hidden);
  c.layers = reader.optional("layers", c.layers);
  c.cell = reader.optional("cell", c.cell);
  c.feedback = reader.optional("feedback", c.feedback);
  reader.finish();
  requireRange(reader, "pose_dim", c.poseDim, 1, 10000);
  requireRange(reader, "control_dim", c.controlDim, 1, 10000);
  requireRange(reader, "past", c.past, 0, 1000);
  requireRange(reader, "lookahead", c.lookahead, 0, 1000);
  requireRange(reader, "hidden", c.hidden, 1, 16384);
  requireRange(reader, "layers", c.layers, 1, 16);
  if (c.feedback) requireRange(reader, "past", c.past, 1, 1000);
  if (c.cell != "lstm" && c.cell != "gru")
    throw InputError(reader.place("cell"), "lstm or gru", "'" + c.cell + "'");
  return c;
}

Json toJson(const Config& c) {
  Json out = {{"pose_dim", c.poseDim}, {"control_dim", c.controlDim},
              {"past", c.past},        {"lookahead", c.lookahead},
              {"hidden", c.hidden},    {"layers", c.layers},
              {"cell", c.cell}};
  if (c.feedback) out["feedback"] = true;
  return out;
}

}  // namespace marey::rnn

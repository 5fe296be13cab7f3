#include "vae/config.h"

namespace marey::vae {
namespace {

void checkRange(const JsonReader& reader, const std::string& key, double value, double low,
                double high) {
  if (!(value >= low && value <= high))
    throwInput(reader.place(key), fmt::format("a value from {} to {}", low, high), "{}", value);
}

void check(const Config& c, const JsonReader& reader) {
  checkRange(reader, "pose_dim", c.poseDim, 1, 10000);
  checkRange(reader, "control_dim", c.controlDim, 1, 10000);
  checkRange(reader, "hidden", c.hidden, 1, 16384);
  checkRange(reader, "layers", c.layers, 1, 16);
  checkRange(reader, "latent", c.latent, 1, 1024);
  checkRange(reader, "kld_weight", c.kldWeight, 0.0, 1e6);
  checkRange(reader, "kld_warmup_steps", c.kldWarmupSteps, 0, 1e9);
  if (c.decoder != "deterministic" && c.decoder != "gaussian")
    throw InputError(reader.place("decoder"), "deterministic or gaussian", "'" + c.decoder + "'");
}

/// Of bidirectional LSTM layers: input, recurrent and two bias weights of four gates, both ways.
int64_t recurrentParameters(const Config& c, int64_t inputs) {
  const int64_t h = c.hidden;
  int64_t out = 0;
  for (int64_t layer = 0; layer < c.layers; ++layer)
    out += 2 * 4 * h * ((layer == 0 ? inputs : 2 * h) + h + 2);
  return out;
}

}  // namespace

Config configFromJson(const Json& value, const std::string& origin) {
  if (value.is_object() && value.contains("model") && value["model"].is_object())
    return configFromJson(value["model"], origin);
  JsonReader reader(value, origin, "model.");
  Config c;
  c.poseDim = reader.optional("pose_dim", c.poseDim);
  c.controlDim = reader.optional("control_dim", c.controlDim);
  c.hidden = reader.optional("hidden", c.hidden);
  c.layers = reader.optional("layers", c.layers);
  c.latent = reader.optional("latent", c.latent);
  c.decoder = reader.optional("decoder", c.decoder);
  c.kldWeight = reader.optional("kld_weight", c.kldWeight);
  c.kldWarmupSteps = reader.optional("kld_warmup_steps", c.kldWarmupSteps);
  reader.finish();
  check(c, reader);
  return c;
}

Json toJson(const Config& c) {
  return {{"pose_dim", c.poseDim},     {"control_dim", c.controlDim},
          {"hidden", c.hidden},        {"layers", c.layers},
          {"latent", c.latent},        {"decoder", c.decoder},
          {"kld_weight", c.kldWeight}, {"kld_warmup_steps", c.kldWarmupSteps}};
}

int64_t parametersOf(const Config& c) {
  const int64_t both = 2 * int64_t{c.hidden};
  const int64_t encoder =
      recurrentParameters(c, c.controlDim + c.poseDim) + 2 * c.latent * (both + 1);
  const int64_t decoder = recurrentParameters(c, c.controlDim + c.latent) + c.poseDim * (both + 1);
  return encoder + decoder + (c.gaussian() ? c.poseDim : 0);
}

}  // namespace marey::vae

#include "model/sampling_option.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace marey {
namespace {

std::string rangeOf(const SamplingOption& o) {
  if (o.kind == SamplingOption::Kind::Switch) return "0 (off) or 1 (on)";
  return std::isfinite(o.high) ? fmt::format("{:g} to {:g}", o.low, o.high)
                               : fmt::format("{:g} or more", o.low);
}

bool allows(const SamplingOption& o, double value) {
  if (o.kind == SamplingOption::Kind::Switch) return value == 0.0 || value == 1.0;
  return value >= o.low && value <= o.high && std::isfinite(value);
}

const SamplingOption* found(const std::vector<SamplingOption>& schema, const std::string& name) {
  const auto at = std::find_if(schema.begin(), schema.end(),
                               [&](const SamplingOption& o) { return o.name == name; });
  return at == schema.end() ? nullptr : &*at;
}

}  // namespace

SamplingOption temperatureOption(int width) {
  return {
      .name = "temperature",
      .title = "Temperature",
      .about = "Factor on the latents: 0 gives the most likely motion, 1 the model's own spread",
      .count = width};
}

std::string textOf(const SamplingOption& o) {
  return fmt::format("{} ({}{}{}, {:g} unless given): {}", o.name, rangeOf(o),
                     o.unit.empty() ? "" : " ", o.unit, o.fallback, o.about);
}

Json toJson(const SamplingOption& o) {
  Json out = {{"name", o.name},
              {"title", o.title},
              {"unit", o.unit},
              {"about", o.about},
              {"kind", o.kind == SamplingOption::Kind::Switch ? "switch" : "number"},
              {"low", o.low},
              {"high", nullptr},
              {"default", o.fallback}};
  if (std::isfinite(o.high)) out["high"] = o.high;
  return out;
}

void requireOption(const std::vector<SamplingOption>& schema, const std::string& name, double value,
                   const std::string& origin) {
  const Place place{.path = origin, .item = name};
  const SamplingOption* option = found(schema, name);
  if (option == nullptr) {
    std::string known;
    for (const SamplingOption& o : schema) known += (known.empty() ? "" : ", ") + o.name;
    throw InputError(place,
                     schema.empty() ? "no option: this model draws nothing that could be changed"
                                    : "one of its options " + known,
                     "another");
  }
  if (!allows(*option, value)) throwInput(place, rangeOf(*option), "{:g}", value);
}

void requireOptions(const std::vector<SamplingOption>& schema, const OptionValues& values,
                    const std::string& origin) {
  for (const auto& [name, value] : values) requireOption(schema, name, value, origin);
}

void applyOptions(const std::vector<SamplingOption>& schema, const OptionValues& values,
                  float* latent) {
  for (const auto& [name, value] : values) {
    const SamplingOption* option = found(schema, name);
    if (option == nullptr) continue;
    for (int i = option->first; i < option->first + option->count; ++i)
      latent[i] = static_cast<float>(static_cast<double>(latent[i]) * value);
  }
}

std::string textOf(const OptionValues& values) {
  std::string out;
  for (const auto& [name, value] : values)
    out += fmt::format("{}{} {:g}", out.empty() ? "" : ", ", name, value);
  return out;
}

void addOption(const std::string& text, OptionValues& values) {
  const size_t equals = text.find('=');
  const auto refuse = [&] {
    throw UsageError("--option: expected NAME=VALUE, a number or on or off, found '" + text + "'");
  };
  if (equals == std::string::npos || equals == 0) refuse();
  const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
  double number = value == "on" ? 1.0 : 0.0;
  if (value != "on" && value != "off") {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number))
      refuse();
  }
  if (!values.emplace(name, number).second)
    throw UsageError("--option: " + name + " is given twice");
}

}  // namespace marey

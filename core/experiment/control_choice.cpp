#include "experiment/control_choice.h"

namespace marey {

void addTo(Json& object, const ControlChoice& choice) {
  if (!choice.type.empty()) object["type"] = choice.type;
  for (const auto& [channel, file] : choice.signals) object["signals"][channel] = file;
  if (!choice.leftOut.empty()) object["left_out"] = choice.leftOut;
  if (!choice.body.empty()) object["body"] = choice.body;
}

ControlChoice controlChoiceFrom(JsonReader& reader) {
  ControlChoice out{.type = reader.optional<std::string>("type", ""),
                    .signals = {},
                    .leftOut = reader.optional("left_out", std::vector<std::string>()),
                    .body = reader.optional<std::string>("body", "")};
  if (!reader.has("signals")) return out;
  const Json& signals = reader.raw("signals");
  if (!signals.is_object())
    throw InputError(reader.place("signals"), "an object {channel: file}", signals.type_name());
  for (const auto& [channel, file] : signals.items()) {
    if (!file.is_string())
      throw InputError(reader.place("signals." + channel), "a file", jsonText(file));
    out.signals[channel] = file.get<std::string>();
  }
  return out;
}

}  // namespace marey

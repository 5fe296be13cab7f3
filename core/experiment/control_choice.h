// What is asked of a motion beside its way, as commands and documents say it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

struct ControlChoice {
  std::string
      type;  ///< a label for all of it, in place of those of way-points or clip; empty: those
  std::map<std::string, std::string> signals;  ///< file of each channel, in place of a clip's
  std::vector<std::string> leftOut;            ///< names of channels
  std::string body;  ///< motion file whose skeleton is the body; empty: the clip's or the model's

  bool operator==(const ControlChoice&) const = default;
};

/// Keys "type", "signals" {channel: file}, "left_out" and "body", where they say something.
void addTo(Json& object, const ControlChoice& choice);
/// Takes those keys. Throws InputError.
ControlChoice controlChoiceFrom(JsonReader& reader);

}  // namespace marey

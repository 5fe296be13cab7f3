#include "base/error.h"

namespace marey {

std::string Place::text() const {
  std::string out = path;
  if (line) out += fmt::format(":{}", *line);
  if (frame) out += fmt::format(", frame {}", *frame);
  if (!item.empty()) out += fmt::format(", {}", item);
  return out;
}

InputError::InputError(const Place& place, const std::string& expected, const std::string& found)
    : Error(fmt::format("{}: expected {}, found {}", place.text(), expected, found)) {}

}  // namespace marey

#include "base/format_version.h"

namespace marey {

int readFormatVersion(JsonReader& reader, int newest) {
  const int found = reader.optional("version", 1);
  if (found < 1 || found > newest)
    throwInput(reader.place("version"),
               fmt::format("a version from 1 to {}{}", newest,
                           found > newest ? " (a newer Marey wrote this)" : ""),
               "{}", found);
  return found;
}

}  // namespace marey

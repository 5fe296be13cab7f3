// Lists and limits of values in JSON that is read strictly.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

/// Throws InputError naming the key unless value >= least.
template <typename T>
void requireAtLeast(const JsonReader& reader, const char* key, T value, T least) {
  if (!(value >= least))
    throwInput(reader.place(key), fmt::format("at least {}", least), "{}", value);
}

/// What `parse` makes of every item of a list; nothing where there is no such key.
template <typename T>
std::vector<T> listFrom(JsonReader& reader, const std::string& key,
                        T (*parse)(const Json&, const std::string&, const std::string&),
                        const std::string& prefix = {}) {
  std::vector<T> out;
  if (!reader.has(key)) return out;
  const Json& list = reader.raw(key);
  if (!list.is_array()) throw InputError(reader.place(key), "a list", list.type_name());
  for (size_t i = 0; i < list.size(); ++i)
    out.push_back(parse(list[i], reader.origin(), fmt::format("{}{}[{}].", prefix, key, i)));
  return out;
}

}  // namespace marey

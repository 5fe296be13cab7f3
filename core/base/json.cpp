#include "base/json.h"

#include <algorithm>

#include "base/atomic_file.h"

namespace marey {

Json parseJson(std::string_view text, const std::string& origin) {
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    const size_t end = std::min(e.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(end), '\n');
    throw InputError({.path = origin, .line = line}, "JSON", e.what());
  }
}

Json readJson(const std::filesystem::path& path) {
  return parseJson(readFile(path, size_t{256} << 20), path.string());
}

void writeJson(const std::filesystem::path& path, const Json& value) {
  writeFileAtomically(path, value.dump(2) + "\n");
}

JsonReader::JsonReader(const Json& value, std::string origin, std::string prefix)
    : m_value(value), m_origin(std::move(origin)), m_prefix(std::move(prefix)) {
  if (!value.is_object())
    throw InputError({.path = m_origin, .item = m_prefix}, "a JSON object", value.type_name());
}

void JsonReader::finish() const {
  for (const auto& [key, value] : m_value.items())
    if (!m_seen.contains(key)) throw InputError(place(key), "a known key", "an unknown one");
}

}  // namespace marey

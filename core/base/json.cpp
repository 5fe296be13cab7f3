#include "base/json.h"

#include <algorithm>

#include "base/atomic_file.h"

namespace marey {

namespace {

/// Copying and writing a value recurses, so that a file of brackets could exhaust the stack.
constexpr int kMaxDepth = 200;

int64_t lineOf(std::string_view text, size_t position) {
  return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n');
}

void checkDepth(std::string_view text, const std::string& origin) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxDepth)
      throw InputError({.path = origin, .line = lineOf(text, i)},
                       fmt::format("JSON of at most {} levels", kMaxDepth), "more");
  }
}

}  // namespace

Json parseJson(std::string_view text, const std::string& origin) {
  checkDepth(text, origin);
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    // `byte` is the 1-based position of the character that was read last.
    const size_t position = std::min(e.byte > 0 ? e.byte - 1 : 0, text.size());
    throw InputError({.path = origin, .line = lineOf(text, position)}, "JSON", e.what());
  } catch (const nlohmann::json::exception& e) {  // a number beyond the range of double
    throw InputError({.path = origin}, "JSON", e.what());
  }
}

std::string jsonText(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json readJson(const std::filesystem::path& path) {
  return parseJson(readFile(path, size_t{256} << 20), path.string());
}

void writeJson(const std::filesystem::path& path, const Json& value) {
  writeFileAtomically(path, jsonText(value, 2) + "\n");
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

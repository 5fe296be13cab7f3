// JSON with errors that name the file and the key.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace marey {

using Json = nlohmann::ordered_json;

/// Throws FileError or InputError (with the line of a syntax error).
Json readJson(const std::filesystem::path& path);
/// `origin` names the text in errors.
Json parseJson(std::string_view text, const std::string& origin);
/// The value as text on one line, or indented. Bytes that are no UTF-8 (names out of old motion
/// files) become U+FFFD.
std::string jsonText(const Json& value, int indent = -1);
/// Indented, written atomically.
void writeJson(const std::filesystem::path& path, const Json& value);

/// Reads an object strictly: every key must be asked for, and `finish()` rejects the rest.
class JsonReader {
 public:
  /// Throws InputError when `value` is no object.
  JsonReader(const Json& value, std::string origin, std::string prefix = {});

  bool has(const std::string& key) const { return m_value.contains(key); }
  /// Throws InputError when the key is missing or of another type.
  template <typename T>
  T required(const std::string& key) {
    m_seen.insert(key);
    if (!has(key)) throw InputError(place(key), "a value", "none");
    return convert<T>(key);
  }
  template <typename T>
  T optional(const std::string& key, T fallback) {
    m_seen.insert(key);
    if (!has(key) || m_value.at(key).is_null()) return fallback;
    return convert<T>(key);
  }
  /// The raw value of a key (marks it as known).
  const Json& raw(const std::string& key) {
    m_seen.insert(key);
    if (!has(key)) throw InputError(place(key), "a value", "none");
    return m_value.at(key);
  }
  JsonReader object(const std::string& key) { return {raw(key), m_origin, m_prefix + key + "."}; }
  Place place(const std::string& key) const {
    return {.path = m_origin, .item = "key '" + m_prefix + key + "'"};
  }
  const std::string& origin() const { return m_origin; }
  /// Throws InputError when there are keys that nobody asked for (a misspelt option).
  void finish() const;

 private:
  template <typename T>
  struct IsVector : std::false_type {};
  template <typename T>
  struct IsVector<std::vector<T>> : std::true_type {};

  static std::string shown(const Json& value) { return jsonText(value).substr(0, 80); }
  template <typename T>
  static bool fits(const Json& value) {
    if (value.is_number_unsigned()) return std::in_range<T>(value.get<uint64_t>());
    return value.is_number_integer() && std::in_range<T>(value.get<int64_t>());
  }
  template <typename T>
  T convert(const std::string& key) const {
    return convertValue<T>(m_value.at(key), key);
  }
  template <typename T>
  T convertValue(const Json& value, const std::string& key) const {
    if constexpr (IsVector<T>::value) {
      if (!value.is_array()) throw InputError(place(key), "a list", shown(value));
      T out;
      for (const Json& item : value) out.push_back(convertValue<typename T::value_type>(item, key));
      return out;
    } else if constexpr (std::is_same_v<T, bool>) {
      if (!value.is_boolean()) throw InputError(place(key), "true or false", shown(value));
    } else if constexpr (std::is_integral_v<T>) {
      if (!fits<T>(value))
        throw InputError(place(key),
                         fmt::format("a whole number from {} to {}", std::numeric_limits<T>::min(),
                                     std::numeric_limits<T>::max()),
                         shown(value));
    } else if constexpr (std::is_floating_point_v<T>) {
      if (!value.is_number() || !std::isfinite(static_cast<T>(value.get<double>())))
        throw InputError(place(key), "a number", shown(value));
    }
    try {
      return value.get<T>();
    } catch (const nlohmann::json::exception&) {
      throw InputError(place(key), "a value of another type", shown(value));
    }
  }

  const Json& m_value;
  std::string m_origin;
  std::string m_prefix;
  std::set<std::string> m_seen;
};

}  // namespace marey

// Text of unknown origin, made safe for JSON and terminals. Private to the PyTorch reader.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace marey::pickle {

/// Whether the bytes are valid UTF-8 (no overlong forms, no surrogates).
bool isUtf8(std::string_view bytes);
std::string utf8FromLatin1(std::string_view bytes);
/// Empty when a character lies outside Latin-1. `utf8` must be valid.
std::optional<std::string> latin1FromUtf8(std::string_view utf8);
/// At most 80 characters, with '?' for everything but printable ASCII.
std::string printable(std::string_view text);

}  // namespace marey::pickle

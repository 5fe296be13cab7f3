#include "base/npy_text.h"

#include <cstring>

#include <fmt/format.h>

namespace marey {
namespace {

void append(std::string& out, uint32_t c) {
  if (c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) c = 0xFFFD;
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((c >> shift) & 0x3F)); };
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xC0 | (c >> 6));
    tail(0);
  } else if (c < 0x10000) {
    out += static_cast<char>(0xE0 | (c >> 12));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xF0 | (c >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
}

struct Character {
  uint32_t code = 0;
  size_t bytes = 0;  ///< 0 where none begins here
};

Character characterAt(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return {first, 1};
  const size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return {};
  uint32_t code = first & (0x7FU >> length);
  for (size_t i = 1; i < length; ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c & 0xC0U) != 0x80) return {};
    code = code << 6U | (c & 0x3FU);
  }
  const uint32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
  if (code < least || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
  return {code, length};
}

}  // namespace

std::string utf8FromUtf32(std::string_view bytes, bool bigEndian) {
  std::string out;
  size_t end = bytes.size() / 4 * 4;
  const auto codeAt = [&](size_t at) {
    uint32_t code = 0;
    std::memcpy(&code, bytes.data() + at, 4);
    return bigEndian ? __builtin_bswap32(code) : code;
  };
  while (end > 0 && codeAt(end - 4) == 0) end -= 4;
  for (size_t at = 0; at < end; at += 4) append(out, codeAt(at));
  return out;
}

std::u32string utf32FromUtf8(std::string_view text) {
  std::u32string out;
  while (!text.empty()) {
    const Character c = characterAt(text);
    if (c.bytes > 0) {
      out += static_cast<char32_t>(c.code);
    } else {
      for (const char digit : fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0])))
        out += static_cast<char32_t>(digit);
    }
    text.remove_prefix(c.bytes > 0 ? c.bytes : 1);
  }
  return out;
}

}  // namespace marey

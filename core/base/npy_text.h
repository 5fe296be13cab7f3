// NumPy's text values ('<U': UTF-32 padded with NULs) to UTF-8 and back. Private to the reader.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace marey {

/// One value: a multiple of four bytes. What is no character becomes U+FFFD.
std::string utf8FromUtf32(std::string_view bytes, bool bigEndian);
/// Characters of UTF-8 text; a byte that is none stays visible as the four characters "\xNN".
std::u32string utf32FromUtf8(std::string_view text);

}  // namespace marey

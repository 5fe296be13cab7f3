// Content hashes for recipes and caches (XXH3, 128 bit; not cryptographic).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace marey {

/// 32 lower-case hexadecimal digits.
std::string contentHash(std::string_view bytes);
/// Of bytes that come in parts: the same as of all of them in one.
std::string contentHash(std::span<const std::string_view> parts);

}  // namespace marey

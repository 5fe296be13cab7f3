// Content hashes for recipes and caches (XXH3, 128 bit; not cryptographic).
#pragma once

#include <string>
#include <string_view>

namespace marey {

/// 32 lower-case hexadecimal digits.
std::string contentHash(std::string_view bytes);

}  // namespace marey

#include "base/hash.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

namespace marey {

namespace {

std::string textOf(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string contentHash(std::string_view bytes) {
  return textOf(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string contentHash(std::span<const std::string_view> parts) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  for (const auto& part : parts) XXH3_128bits_update(&state, part.data(), part.size());
  return textOf(XXH3_128bits_digest(&state));
}

}  // namespace marey

#include "base/random.h"

#include <cmath>
#include <numbers>

namespace marey {
namespace {

std::array<uint32_t, 4> block(const RandomKey& key, uint32_t index) {
  // Stage and the low bits of the index share a word; the high bits have one of their own.
  const uint32_t word = (static_cast<uint32_t>(key.stage) << 24) | (index & 0xFFFFFFu);
  return philox4x32({word, key.frame, key.sample, index >> 24},
                    {static_cast<uint32_t>(key.seed), static_cast<uint32_t>(key.seed >> 32)});
}

/// (0, 1]: never zero, so that its logarithm exists.
double openUniform(uint32_t word) {
  return (static_cast<double>(word) + 1.0) * 0x1p-32;
}

std::array<double, 4> normalBlock(const RandomKey& key, uint32_t index) {
  const auto words = block(key, index);
  std::array<double, 4> out{};
  for (int pair = 0; pair < 2; ++pair) {
    const double radius = std::sqrt(-2.0 * std::log(openUniform(words[2 * pair])));
    const double angle =
        2.0 * std::numbers::pi * (static_cast<double>(words[2 * pair + 1]) * 0x1p-32);
    out[2 * pair] = radius * std::cos(angle);
    out[2 * pair + 1] = radius * std::sin(angle);
  }
  return out;
}

}  // namespace

std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> c, std::array<uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t p0 = 0xD2511F53ull * c[0];
    const uint64_t p1 = 0xCD9E8D57ull * c[2];
    c = {static_cast<uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<uint32_t>(p1),
         static_cast<uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<uint32_t>(p0)};
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
  return c;
}

void fillNormal(const RandomKey& key, std::span<float> out) {
  for (size_t i = 0; i < out.size(); i += 4) {
    const auto values = normalBlock(key, static_cast<uint32_t>(i / 4));
    for (size_t j = 0; j < 4 && i + j < out.size(); ++j) out[i + j] = static_cast<float>(values[j]);
  }
}

double uniformAt(const RandomKey& key, uint32_t index) {
  return static_cast<double>(block(key, index / 4)[index % 4]) * 0x1p-32;
}

double normalAt(const RandomKey& key, uint32_t index) {
  return normalBlock(key, index / 4)[index % 4];
}

double chiSquared(const RandomKey& key, double df) {
  // Gamma(shape) by rejection; shapes below 1 are raised by 1 and corrected with a power.
  const double shape = df / 2.0;
  const double d = (shape < 1.0 ? shape + 1.0 : shape) - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (uint32_t attempt = 0;; ++attempt) {
    // Blocks of 8 numbers per attempt: two for the normal, the rest for uniforms.
    const double x = normalAt(key, 8 * attempt);
    const double v = std::pow(1.0 + c * x, 3.0);
    const double u = 1.0 - uniformAt(key, 8 * attempt + 4);
    if (v <= 0.0 || std::log(u) >= 0.5 * x * x + d - d * v + d * std::log(v)) continue;
    const double boost =
        shape < 1.0 ? std::pow(1.0 - uniformAt(key, 8 * attempt + 5), 1.0 / shape) : 1.0;
    return 2.0 * d * v * boost;
  }
}

}  // namespace marey

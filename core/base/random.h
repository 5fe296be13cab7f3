// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random
// numbers: as easy as 1, 2, 3"). A value depends on (seed, sample, frame, stage, index)
// alone, so results are the same bits for any batch size and thread count.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace marey {

/// What a stream of numbers is for; keeps streams apart.
enum class RandomStage : uint32_t {
  Latent = 0,
  Dropout = 1,
  Shuffle = 2,
  Weights = 3,
  Walker = 4,
  Bootstrap = 5,
  StudentT = 6,
  Test = 7,
  Observation = 8,
  Control = 9,
};

/// The raw block function: counter (4 words), key (2 words) -> 4 random words.
std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// Where a stream starts. `sample` and `frame` are free to mean other things for other stages.
struct RandomKey {
  uint64_t seed = 0;
  uint32_t sample = 0;
  uint32_t frame = 0;
  RandomStage stage = RandomStage::Latent;
};

/// Fills `out` with standard normal values (Box-Muller, double inside).
void fillNormal(const RandomKey& key, std::span<float> out);
/// One uniform value in [0, 1): number `index` of the stream.
double uniformAt(const RandomKey& key, uint32_t index);
/// One standard normal value: number `index` of the stream.
double normalAt(const RandomKey& key, uint32_t index);
/// One chi-squared value with df > 0 degrees of freedom (Marsaglia and Tsang 2000); the stream
/// of the key is used up by it.
double chiSquared(const RandomKey& key, double df);

}  // namespace marey

// Counter-based pseudo-random numbers, which depend only on a counter and a key: Philox4x32-10 of Salmon et al. 2011,
// "Parallel random numbers: as easy as 1, 2, 3". Integer arithmetic makes them identical on all machines.
#pragma once

#include <array>
#include <cstdint>

namespace thawslide {

// Four words of 32 random bits.
inline std::array<std::uint32_t, 4> random_words(std::array<std::uint32_t, 4> counter,
                                                 std::array<std::uint32_t, 2> key) {
  constexpr int rounds = 10;
  constexpr std::uint64_t first_factor = 0xD2511F53U, second_factor = 0xCD9E8D57U;
  constexpr std::uint32_t golden_ratio = 0x9E3779B9U, root_of_three = 0xBB67AE85U;  // their fractions, times 2^32
  for (int round = 0; round < rounds; ++round) {
    const std::uint64_t first = first_factor * counter[0], second = second_factor * counter[2];
    counter = {static_cast<std::uint32_t>(second >> 32U) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
               static_cast<std::uint32_t>(first >> 32U) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += golden_ratio;
    key[1] += root_of_three;
  }
  return counter;
}

// Number between -1 and 1, exclusive, uniformly distributed and symmetric around 0; exact.
inline double between_minus_one_and_one(std::uint32_t word) {
  constexpr double half_range = 2147483648.0;  // 2^31
  return (static_cast<double>(word) + 0.5) / half_range - 1.0;
}

}  // namespace thawslide

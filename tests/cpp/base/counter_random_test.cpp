#include "base/counter_random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thawslide {
namespace {

using Counter = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

// Test vectors published by Salmon et al. with their generator.
TEST(CounterRandom, ReproducesThePublishedTestVectors) {
  EXPECT_EQ(random_words(Counter{0, 0, 0, 0}, Key{0, 0}),
            (Counter{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  constexpr std::uint32_t ones = 0xffffffffU;
  EXPECT_EQ(random_words(Counter{ones, ones, ones, ones}, Key{ones, ones}),
            (Counter{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  EXPECT_EQ(random_words(Counter{0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}, Key{0xa4093822U, 0x299f31d0U}),
            (Counter{0xd16cfe09U, 0x94fdcceb, 0x5001e420U, 0x24126ea1U}));
}

TEST(CounterRandom, NumbersAreUniformlyDistributed) {
  EXPECT_EQ(between_minus_one_and_one(0), -1.0 + std::ldexp(1.0, -32));
  EXPECT_EQ(between_minus_one_and_one(0xffffffffU), 1.0 - std::ldexp(1.0, -32));
  EXPECT_EQ(between_minus_one_and_one(0x7fffffffU), -between_minus_one_and_one(0x80000000U));
  // Neighbouring counters and keys: mean 0, mean square 1/3, no correlation between consecutive numbers.
  constexpr int count = 20000;
  double sum = 0.0, squares = 0.0, along = 0.0, across = 0.0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double here = between_minus_one_and_one(random_words({k, 0, 0, 0}, {5, 0})[0]);
    sum += here;
    squares += here * here;
    along += here * between_minus_one_and_one(random_words({k + 1, 0, 0, 0}, {5, 0})[0]);
    across += here * between_minus_one_and_one(random_words({k, 0, 0, 0}, {6, 0})[0]);
  }
  const double deviation = 1.0 / std::sqrt(3.0 * count);  // of the mean of that many numbers
  EXPECT_NEAR(sum / count, 0.0, 4.0 * deviation);
  EXPECT_NEAR(squares / count, 1.0 / 3.0, 4.0 * deviation);
  EXPECT_NEAR(along / count, 0.0, 4.0 * deviation);
  EXPECT_NEAR(across / count, 0.0, 4.0 * deviation);
}

}  // namespace
}  // namespace thawslide

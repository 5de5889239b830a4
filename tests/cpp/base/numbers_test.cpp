// Numbers: random ones, sums that do not depend on order, bits in the order of values, rounded texts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/counter_random.hpp"
#include "base/ordered_bits.hpp"
#include "base/rounding.hpp"
#include "base/sums.hpp"

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

// Sum in parts of the given size, which are then added up.
double sum_in_parts(const std::vector<double>& numbers, std::size_t of_a_part) {
  ExactSum all;
  for (std::size_t first = 0; first < numbers.size(); first += of_a_part) {
    ExactSum part;
    for (std::size_t k = first; k < std::min(numbers.size(), first + of_a_part); ++k) {
      part += numbers[k];
    }
    all += part;
  }
  return all;
}

TEST(ExactSum, DoesNotDependOnTheOrder) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> mass(1.0, 1000.0);
  std::vector<double> numbers(20000);
  std::generate(numbers.begin(), numbers.end(), [&] { return mass(random); });
  long double in_more_digits = 0.0L;
  for (const double number : numbers) {
    in_more_digits += number;  // 11 bits more: its rounding is far below the last digit of a double
  }
  const auto expected = static_cast<double>(in_more_digits);
  bool plain_sums_differ = false;
  for (const std::size_t of_a_part : {std::size_t{1}, std::size_t{7}, std::size_t{128}, numbers.size()}) {
    EXPECT_EQ(sum_in_parts(numbers, of_a_part), expected) << of_a_part;
    std::shuffle(numbers.begin(), numbers.end(), random);
    double plain = 0.0;
    for (const double number : numbers) {
      plain += number;
    }
    plain_sums_differ = plain_sums_differ || plain != expected;
  }
  EXPECT_TRUE(plain_sums_differ);
}

TEST(OrderedBits, AreOrderedAsTheirNumbers) {
  using Limits = std::numeric_limits<double>;
  const std::vector<double> ascending{-Limits::infinity(),
                                      -Limits::max(),
                                      -2.0,
                                      -1.0,
                                      -Limits::min(),
                                      -Limits::denorm_min(),
                                      0.0,
                                      Limits::denorm_min(),
                                      1e-3,
                                      1.0,
                                      1.0 + Limits::epsilon(),
                                      7e9,
                                      Limits::infinity()};
  for (std::size_t k = 1; k < ascending.size(); ++k) {
    EXPECT_LT(ordered_bits(ascending[k - 1]), ordered_bits(ascending[k])) << ascending[k];
  }
  EXPECT_EQ(ordered_bits(-0.0), ordered_bits(0.0));
}

TEST(Rounding, RoundsBoundsInTheirDirection) {
  EXPECT_DOUBLE_EQ(rounded_up(1.3e7, 1), 2e7);
  EXPECT_DOUBLE_EQ(rounded_up(1.234e-5, 3), 1.24e-5);
  EXPECT_DOUBLE_EQ(rounded_down(1.9e7, 1), 1e7);
  EXPECT_DOUBLE_EQ(rounded_down(0.014069, 4), 0.01406);
  EXPECT_DOUBLE_EQ(rounded_up(9.6, 1), 10.0) << "with a carry";
}

TEST(Rounding, LeavesShortNumbersUnchanged) {
  for (const double number : {3e-9, 0.3, 1.0, 20.0, 7e12}) {
    EXPECT_DOUBLE_EQ(rounded_up(number, 1), number);
    EXPECT_DOUBLE_EQ(rounded_down(number, 1), number);
    EXPECT_DOUBLE_EQ(rounded_up(number * (1.0 + 1e-15), 2), number) << "round-off does not increase it";
    EXPECT_DOUBLE_EQ(rounded_down(number * (1.0 - 1e-15), 2), number) << "or decrease it";
  }
}

TEST(Rounding, SeparatesThousandsByCommas) {
  EXPECT_EQ(with_commas(1.0, 3), "1");
  EXPECT_EQ(with_commas(999.4, 3), "999");
  EXPECT_EQ(with_commas(4512.0, 3), "4,510");
  EXPECT_EQ(with_commas(85333.0, 2), "85,000");
  EXPECT_EQ(with_commas(999999.0, 3), "1,000,000");
  EXPECT_EQ(with_commas(12.6, 3), "13") << "no decimals";
}

TEST(Rounding, EstimatesHaveTwoDigitsAndNoExponent) {
  EXPECT_EQ(rounded_text(0.0346), "0.035");
  EXPECT_EQ(rounded_text(9.97), "10");
  EXPECT_EQ(rounded_text(99.6), "100");
  EXPECT_EQ(rounded_text(12345678.0), "12,000,000");
  EXPECT_EQ(rounded_text(84284.0, 4), "84,280");
  EXPECT_EQ(rounded_text(1e303), "1e+303");
}

TEST(Rounding, CoordinatesHaveSevenDigitsAndNoExponent) {
  EXPECT_EQ(coordinate_text(400805.0), "400805");
  EXPECT_EQ(coordinate_text(-2190.123456), "-2190.123");
  EXPECT_EQ(coordinate_text(0.125), "0.125");
  EXPECT_EQ(coordinate_text(20037508.3), "20037508");
}

}  // namespace
}  // namespace thawslide

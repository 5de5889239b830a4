#include "base/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace thawslide {
namespace {

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

}  // namespace
}  // namespace thawslide

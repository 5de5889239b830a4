// Bounds rounded to few digits remain bounds.
#include "base/rounding.hpp"

#include <gtest/gtest.h>

namespace thawslide {
namespace {

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

// Large numbers for people.
#include "base/thousands.hpp"

#include <gtest/gtest.h>

namespace thawslide {
namespace {

TEST(Thousands, HaveCommasAndAsManyDigitsAsAreAskedFor) {
  EXPECT_EQ(with_commas(1.0, 3), "1");
  EXPECT_EQ(with_commas(999.4, 3), "999");
  EXPECT_EQ(with_commas(4512.0, 3), "4,510");
  EXPECT_EQ(with_commas(85333.0, 2), "85,000");
  EXPECT_EQ(with_commas(999999.0, 3), "1,000,000");
  EXPECT_EQ(with_commas(12.6, 3), "13") << "no decimals";
}

}  // namespace
}  // namespace thawslide

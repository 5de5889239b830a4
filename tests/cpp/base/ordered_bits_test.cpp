#include "base/ordered_bits.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace thawslide {
namespace {

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

}  // namespace
}  // namespace thawslide

// Reordered items compared with a copy of them.
#include "base/reorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace thawslide {
namespace {

TEST(Reorder, IsEqualToACopyInTheNewOrder) {
  std::mt19937 random(7);
  ReorderBuffer buffer;
  for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 1000u, 10000u}) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    for (int trial = 0; trial < 20; ++trial) {
      std::shuffle(order.begin(), order.end(), random);
      std::vector<double> items(count + 2), expected;  // those beyond the order are kept
      std::iota(items.begin(), items.end(), 100.0);
      expected = items;
      for (std::size_t k = 0; k < count; ++k) {
        expected[k] = items[order[k]];
      }
      reorder<double>(
          order, buffer, [&](std::size_t k) { return items[k]; }, [&](std::size_t k, double item) { items[k] = item; });
      ASSERT_EQ(items, expected) << count << " items, trial " << trial;
    }
  }
}

}  // namespace
}  // namespace thawslide

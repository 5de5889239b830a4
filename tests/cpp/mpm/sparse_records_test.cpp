// Records of selected blocks: stored values, zeros elsewhere, and a change of the selection.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mpm/transfer.hpp"

namespace thawslide::mpm {
namespace {

using Records = SparseRecords<2, 3>;

TEST(SparseRecords, StoreRequestedBlocksAndReadZerosElsewhere) {
  Records records;
  records.allocate(5, [](std::size_t block) { return block == 1 || block == 4; });
  for (const std::size_t block : {1u, 4u}) {
    ASSERT_TRUE(records.contains(block));
    for (std::size_t k = 0; k < Records::nodes; ++k) {
      records.of_block(block)[k] = {static_cast<double>(100 * block + k), 1.0, 2.0, 0.0};
    }
  }
  for (std::size_t block = 0; block < 5; ++block) {
    const bool held = block == 1 || block == 4;
    EXPECT_EQ(records.contains(block), held);
    for (std::size_t k = 0; k < Records::nodes; ++k) {
      EXPECT_EQ(records(block, k)[0], held ? static_cast<double>(100 * block + k) : 0.0) << block << ", " << k;
      EXPECT_EQ(records(NodeAt{block, k})[1], held ? 1.0 : 0.0);
    }
  }
}

TEST(SparseRecords, OfReleasedBlocksAreZeroAndReadOnly) {
  Records records;
  records.allocate(3, [](std::size_t /*block*/) { return true; });
  for (std::size_t block = 0; block < 3; ++block) {
    std::fill_n(records.of_block(block), Records::nodes, Records::Record{7.0, 7.0, 7.0, 7.0});
  }
  records.allocate(4, [](std::size_t block) { return block == 3; });
  for (std::size_t block = 0; block < 3; ++block) {
    EXPECT_FALSE(records.contains(block));
    for (std::size_t k = 0; k < Records::nodes; ++k) {
      EXPECT_EQ(records(block, k), Records::Record{}) << block << ", " << k;
    }
    EXPECT_THROW(static_cast<void>(records.of_block(block)), InternalError);
  }
  EXPECT_TRUE(records.contains(3));
}

}  // namespace
}  // namespace thawslide::mpm

#include "base/table.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "base/parallel.hpp"

namespace thawslide {
namespace {

TEST(Table, IsLinearBetweenEntriesAndConstantBeyond) {
  const Table table({0.0, 10.0, 20.0}, {1.0, 3.0, -1.0});
  EXPECT_DOUBLE_EQ(table.at(-5.0), 1.0);
  EXPECT_DOUBLE_EQ(table.at(5.0), 2.0);
  EXPECT_DOUBLE_EQ(table.at(15.0), 1.0);
  EXPECT_DOUBLE_EQ(table.at(99.0), -1.0);
  EXPECT_DOUBLE_EQ(Table(4.5).at(1e9), 4.5);
}

TEST(Table, AtAJumpTheLaterValueApplies) {
  const Table band({0.0, 75.0, 75.0, 200.0}, {0.05, 0.05, 0.5, 0.5});
  EXPECT_DOUBLE_EQ(band.at(74.999), 0.05);
  EXPECT_DOUBLE_EQ(band.at(75.0), 0.5);
}

TEST(BandThickness, IsZeroUnlessGiven) {
  BandThickness thickness;
  EXPECT_FALSE(thickness.is_given());
  EXPECT_DOUBLE_EQ(thickness.at(1.0), 0.0);
  EXPECT_DOUBLE_EQ(thickness.smallest(), 0.0);
  EXPECT_DOUBLE_EQ(thickness.largest(), 0.0);
  thickness.table = Table({0.0, 10.0, 20.0}, {0.3, 0.1, 0.2});
  EXPECT_TRUE(thickness.is_given());
  EXPECT_DOUBLE_EQ(thickness.at(5.0), 0.2);
  EXPECT_DOUBLE_EQ(thickness.smallest(), 0.1);
  EXPECT_DOUBLE_EQ(thickness.largest(), 0.3);
}

TEST(InitialField, LooksUpDepthOrX) {
  InitialField field;
  field.table = Table({0.0, 10.0}, {-2.0, -4.0});
  field.over = InitialField::Over::depth;
  EXPECT_DOUBLE_EQ(field.at(5.0, 1000.0), -3.0);
  field.over = InitialField::Over::x;
  EXPECT_DOUBLE_EQ(field.at(1000.0, 2.5), -2.5);
}

TEST(ParallelFor, RunsEachOnceAndPropagatesExceptions) {
  std::vector<std::atomic<int>> runs(1000);
  parallel_for(runs.size(), [&](std::size_t k) { ++runs[k]; });
  for (const auto& count : runs) {
    EXPECT_EQ(count, 1);
  }
  EXPECT_THROW(parallel_for(100,
                            [](std::size_t k) {
                              if (k == 57) {
                                throw std::runtime_error("57");
                              }
                            }),
               std::runtime_error);
}

TEST(ParallelSum, AddsEachOnceAndInTheSameOrderOnAnyThreads) {
  const int before = thread_count();
  for (const std::size_t count : {0, 1, 8, 9, 255, 256, 257, 1000, 5003}) {
    std::vector<double> sums;
    for (const int threads : {1, 2, 3, 5}) {
      set_thread_count(threads);
      EXPECT_EQ(parallel_sum<std::size_t>(count, [](std::size_t k, std::size_t& sum) { sum += k + 1; }),
                count * (count + 1) / 2);
      sums.push_back(
          parallel_sum<double>(count, [](std::size_t k, double& sum) { sum += 1.0 / static_cast<double>(3 * k + 1); }));
    }
    EXPECT_EQ(std::vector<double>(sums.size(), sums[0]), sums) << count;
  }
  set_thread_count(before);
}

TEST(ThreadScope, RestoresTheNumberOfThreads) {
  const int before = thread_count();
  set_thread_count(3);
  {
    const ThreadScope alone(1);
    EXPECT_EQ(thread_count(), 1);
  }
  EXPECT_EQ(thread_count(), 3);
  set_thread_count(before);
}

}  // namespace
}  // namespace thawslide

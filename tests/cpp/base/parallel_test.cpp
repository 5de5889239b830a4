#include "base/parallel.hpp"

#include <gtest/gtest.h>

namespace thawslide {
namespace {

TEST(ParallelAny, FindsASingleCallOnAnyNumberOfThreads) {
  const int threads_before = thread_count();
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    for (const std::size_t hit : {std::size_t{0}, std::size_t{500}, std::size_t{999}}) {
      EXPECT_TRUE(parallel_any(1000, [&](std::size_t k) { return k == hit; })) << hit << ", threads: " << threads;
    }
    EXPECT_FALSE(parallel_any(1000, [](std::size_t) { return false; }));
    EXPECT_FALSE(parallel_any(0, [](std::size_t) { return true; }));
  }
  set_thread_count(threads_before);
}

}  // namespace
}  // namespace thawslide

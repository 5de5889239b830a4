// Parallel searches, reordered items, and the number of threads that a run chooses.
#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "base/thread_choice.hpp"

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

// A run with a simulated clock, whose steps take step_seconds(threads, time).
struct TimedRun {
  ThreadChoice choice;
  double now = 0.0;
  std::int64_t steps = 0;

  explicit TimedRun(int most) : choice(most, 0.0) {}
  void until(double end, const std::function<double(int, double)>& step_seconds) {
    while (now < end) {
      now += step_seconds(choice.threads(), now);
      choice.after_step(now);
      ++steps;
    }
  }
};

constexpr double step = 0.001;

double shared_well(int threads, double /*time*/) { return step / threads; }
// All threads wait for the one that shares its core with another process.
double next_to_another(int threads, double /*time*/) { return threads == 1 ? step : 2.0 * step; }

TEST(ThreadChoice, UsesAllThreadsOfAQuietMachine) {
  TimedRun run(4);
  run.until(20.0, shared_well);
  EXPECT_EQ(run.choice.threads(), 4);
  EXPECT_GT(static_cast<double>(run.steps), 0.98 * 20.0 / (step / 4));
}

TEST(ThreadChoice, StopsUsingAThreadThatDelaysTheOther) {
  TimedRun run(2);
  run.until(20.0, next_to_another);
  EXPECT_GT(static_cast<double>(run.steps), 0.98 * 20.0 / step);
}

TEST(ThreadChoice, FollowsTheLoadOfTheMachine) {
  TimedRun run(2);
  run.until(20.0, shared_well);
  const std::int64_t before = run.steps;
  run.until(30.0, next_to_another);
  EXPECT_GT(static_cast<double>(run.steps - before), 0.95 * 10.0 / step);
  const std::int64_t adjacent = run.steps;
  run.until(60.0, shared_well);
  EXPECT_GT(static_cast<double>(run.steps - adjacent), 0.9 * 30.0 / (step / 2));
}

TEST(ThreadChoice, FindsFewThreadsAmongMany) {
  // Every thread beyond four costs more time than it saves.
  const auto small_case = [](int threads, double /*time*/) {
    return step / std::min(threads, 4) + 1e-4 * std::max(0, threads - 4);
  };
  TimedRun run(32);
  run.until(60.0, small_case);
  EXPECT_GE(run.choice.threads(), 3);
  EXPECT_LE(run.choice.threads(), 5);
}

TEST(ThreadChoice, LosesLittleIfStepsAreLong) {
  TimedRun run(2);
  run.until(1000.0, [](int threads, double /*time*/) { return 2.0 / threads; });
  EXPECT_EQ(run.choice.threads(), 2);
  EXPECT_GT(static_cast<double>(run.steps), 0.95 * 1000.0);
}

TEST(ThreadChoice, KeepsTheFasterNumberDespiteScatter) {
  // Two threads are a third faster, but the speed of the machine changes 30 times per second between a third and full.
  std::mt19937 random(1);
  std::vector<double> pace(3000);
  std::generate(pace.begin(), pace.end(), [&] { return std::uniform_real_distribution<double>(1.0, 3.0)(random); });
  double with_two = 0.0;
  TimedRun run(2);
  run.until(90.0, [&](int threads, double time) {
    const double seconds = pace[static_cast<std::size_t>(30.0 * time)] * (threads == 2 ? 0.75 : 1.0) * step;
    with_two += threads == 2 ? seconds : 0.0;
    return seconds;
  });
  EXPECT_GT(with_two, 0.9 * 90.0);
}

TEST(ThreadChoice, KeepsASingleThread) {
  TimedRun run(1);
  run.until(1.0, shared_well);
  EXPECT_EQ(run.choice.threads(), 1);
}

}  // namespace
}  // namespace thawslide

// A time step and the gathering of its results allocate nothing after their storage has grown.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "../support/two_bodies.hpp"
#include "base/parallel.hpp"
#include "sim/records/run_records.hpp"

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t bytes, std::size_t boundary) {
  ++allocations;
  void* place = std::aligned_alloc(boundary, (bytes + boundary - 1) / boundary * boundary);
  if (place == nullptr) {
    throw std::bad_alloc();
  }
  return place;
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t boundary) {
  return allocate(bytes, static_cast<std::size_t>(boundary));
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t /*bytes*/) noexcept { std::free(place); }
void operator delete(void* place, std::align_val_t /*boundary*/) noexcept { std::free(place); }
void operator delete(void* place, std::size_t /*bytes*/, std::align_val_t /*boundary*/) noexcept { std::free(place); }

namespace thawslide::sim {
namespace {

// Bodies large enough that loops over tiles are distributed to threads; sets: keys of the case.
template <int Dim>
long allocations_of_steps(const testing_support::Sets& sets = {}) {
  const int threads_before = thread_count();
  set_thread_count(2);
  Simulation<Dim> simulation(testing_support::two_bodies<Dim>(5e3, 30.0, 5.0, 0.0, sets));
  EXPECT_GE(simulation.grid().tiles().size(), fewest_shared_calls);
  simulation.set_sorting_interval(5);
  RunRecords<Dim> records(simulation, {});
  records.start(simulation);
  for (int k = 0; k < 20; ++k) {
    simulation.step(simulation.next_step(1.0));
    records.after_step(simulation);
  }
  const long before = allocations;
  for (int k = 0; k < 20; ++k) {
    simulation.step(simulation.next_step(1.0));
    records.after_step(simulation);
  }
  const long during = allocations - before;
  set_thread_count(threads_before);
  return during;
}

TEST(Step, AllocatesNothingInThePlane) {
  EXPECT_GT(allocations, 0);
  EXPECT_EQ(allocations_of_steps<2>(), 0);
}
TEST(Step, AllocatesNothingInSpace) { EXPECT_EQ(allocations_of_steps<3>(), 0); }
TEST(Step, AllocatesNothingWithAdaptiveSteps) {
  for (const std::string band : {"band.thickness=0.1", "band.thickness={time=[0.0,1.0],value=[0.1,0.2]}"}) {
    EXPECT_EQ(allocations_of_steps<2>({"time.stepping=adaptive", band}), 0) << band;
    EXPECT_EQ(allocations_of_steps<3>({"time.stepping=adaptive", band}), 0) << band;
  }
}

}  // namespace
}  // namespace thawslide::sim

// Sums over many parts on a device (device/add_up.hpp) are bitwise identical to those of the CPU.
#include "device/add_up.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include "base/parallel.hpp"
#include "device/host_backend.hpp"
#include "exec/array.hpp"

namespace thawslide::device {
namespace {

// Numbers of very different magnitudes, such that a different order changes the sum.
std::vector<double> parts_of(std::size_t count) {
  std::mt19937 random(7);
  std::vector<double> parts(count);
  for (double& part : parts) {
    part = std::normal_distribution<double>(0.0, 1.0)(random) *
           std::pow(10.0, std::uniform_int_distribution(-8, 8)(random));
  }
  return parts;
}

double on_cpu(const std::vector<double>& parts) {
  return parallel_sum<double>(parts.size(), [&](std::size_t k, double& sum) { sum = parts[k]; });
}

double on_device(const std::vector<double>& parts, ThreadOrder order) {
  Host host(order);
  exec::Array<double, Host> sums(host);
  std::vector<double> padded = parts;
  padded.resize(partial_sum_count(parts.size()));
  sums.set(padded);
  const double* sum = add_up(host, sums.data(), parts.size());
  double found = 0.0;
  host.copy_out(&found, sum, 1);
  EXPECT_EQ(host.launches(), runs_of(parts.size()) == 1 ? 1u : 2u);
  return found;
}

TEST(AddUp, IsBitwiseIdenticalToTheCpu) {
  const std::size_t run = parts_of_a_run;
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, run - 1, run, run + 1, 2 * run, 5 * run + 3, run * run, run * run + run + 1}) {
    const std::vector<double> parts = parts_of(count);
    for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::shuffled}) {
      EXPECT_EQ(on_device(parts, order), on_cpu(parts)) << count;
    }
    EXPECT_TRUE(count < 5 * run || on_cpu(parts) != std::accumulate(parts.begin(), parts.end(), 0.0))
        << "the order of these parts has an effect";
  }
}

}  // namespace
}  // namespace thawslide::device

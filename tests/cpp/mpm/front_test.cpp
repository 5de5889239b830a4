// Front of the sliding mass on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "exec/cpu.hpp"
#include "mpm/front_stage.hpp"
#include "mpm/particles.hpp"

namespace thawslide::mpm {
namespace {

struct MassOnPath {
  double along, mass;  // [m, kg]
};

double front_of(const std::vector<MassOnPath>& masses, double mass) {
  Particles<2> particles;
  particles.resize(masses.size());
  std::vector<std::uint32_t> order(masses.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t p = 0; p < masses.size(); ++p) {
    particles.position(p, 0) = masses[p].along;
    particles.mass(p) = masses[p].mass;
  }
  exec::Cpu cpu;
  return Front<exec::Cpu, 2>(cpu).find({}, mass, view_of(particles), order.data(), order.size()).along;
}

TEST(Front, LeavesHalfAPercentOfTheMassAhead) {
  std::mt19937 random(3);
  std::vector<MassOnPath> masses;
  for (std::size_t k = 0; k < 1000; ++k) {
    masses.push_back({static_cast<double>(k), 2.0});
  }
  std::shuffle(masses.begin(), masses.end(), random);
  // 6 of 1000 particles are at or ahead of particle 994: less than 99.5 % are behind it.
  EXPECT_EQ(front_of(masses, 2000.0), 994.0);
  EXPECT_EQ(front_of({{5.0, 1.0}}, 1.0), 5.0);
  EXPECT_EQ(front_of({{0.0, 1.0}, {1.0, 1e-6}, {2.0, 1e-6}}, 1.0 + 2e-6), 0.0);
}

// More particles are ahead than are read at a time.
TEST(Front, IsFoundBehindManyLightParticles) {
  std::vector<MassOnPath> masses(5000, {1.0, 0.0});
  masses[0] = {0.0, 1.0};
  masses[1] = {-1.0, 1.0};
  EXPECT_EQ(front_of(masses, 2.0), 0.0);
  EXPECT_EQ(front_of(masses, 1000.0), -1.0) << "the last one";
}

}  // namespace
}  // namespace thawslide::mpm

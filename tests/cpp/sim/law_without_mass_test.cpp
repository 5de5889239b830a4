// A basal law that does not depend on the mass gives the same bits without the sums of particles near the ground.
#include <gtest/gtest.h>

#include <vector>

#include "../support/following_slides.hpp"

namespace thawslide::sim {
namespace {

using testing_support::slide_in_gully;
using testing_support::slide_on_plane;

// Velocities of all particles after some steps. The law of the caller keeps the strengths, but receives the mass.
template <int Dim>
std::vector<double> velocities(Simulation<Dim>& simulation, bool reads_mass) {
  std::size_t read = 0;
  const terrain::StrengthLaw unchanged = [&](terrain::LoadedNodes& nodes) {
    for (const double fraction : nodes.solid_fraction) {
      EXPECT_GT(fraction, 0);
      ++read;
    }
  };
  for (int step = 0; step < 40; ++step) {
    simulation.step(0.01, reads_mass ? &unchanged : nullptr);
  }
  EXPECT_EQ(read > 0, reads_mass);
  std::vector<double> all;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    for (int a = 0; a < Dim; ++a) {
      all.push_back(simulation.particles().velocity(p, a));
    }
  }
  return all;
}

TEST(LawWithoutMass, IsBitwiseEqualToTheSumsNearTheGround) {
  const testing_support::Sets coulomb = "basal.friction=constant; basal.friction_angle=15";
  const auto plane = slide_on_plane(30.0, coulomb), plane_with_sums = slide_on_plane(30.0, coulomb);
  EXPECT_EQ(velocities(*plane, false), velocities(*plane_with_sums, true));
  const auto gully = slide_in_gully(coulomb), gully_with_sums = slide_in_gully(coulomb);
  EXPECT_EQ(velocities(*gully, false), velocities(*gully_with_sums, true));
}

}  // namespace
}  // namespace thawslide::sim

// The stored ground data of the grid follow the slide.
#include "../support/slide_in_space.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

TEST(GroundMemory, IsReleasedBehindTheSlide) {
  Simulation<3> simulation(
      testing_support::slide_in_space("body.box.velocity=[80,0,0]; grid.max=[200,15,20]; material.rock.law=elastic; "
                                      "material.rock.viscosity_time=0.01"));
  std::size_t most_held = 0, most_active = 0, seen = 0;
  for (int k = 0; k < 1000; ++k) {  // about 170 m, nearly thirty times the length of the body
    const std::size_t before = simulation.ground()->stored();
    simulation.step(0.002);
    const std::size_t after = simulation.ground()->stored();
    seen += after > before ? after - before : 0;
    most_held = std::max(most_held, after);
    most_active = std::max(most_active, simulation.grid().blocks().size());
  }
  EXPECT_GT(seen, 3 * most_active);  // the slide has passed over more ground than may be stored
  EXPECT_LE(most_held, 4 * most_active);
}

}  // namespace
}  // namespace thawslide::sim

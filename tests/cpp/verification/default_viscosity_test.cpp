// The default viscosity (material.NAME.viscosity_number) damps the noise of sliding blocks on every cell.
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/following_plane.hpp"
#include "../support/record.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;

// Block of 200 m x 60 m, normal to a plane of 30 degrees, that has slid down for 20 s at a friction angle of 20
// degrees.
class SlidingBlock {
 public:
  SlidingBlock(double cell, double cohesion, const std::string& viscosity)
      : simulation_(body_on_plane(
            plane_, cell, {plane_.place(-100, 0), plane_.place(100, 0), plane_.place(100, 60), plane_.place(-100, 60)},
            {"material.grains.youngs_modulus=5e8", fmt::format("material.grains.cohesion={}", cohesion),
             "basal.friction_angle=20", "grid.max=[3000,400]", "grid.min=[-700,-2000]",
             "material.grains." + viscosity})) {
    run_until(simulation_, 20.0);
  }

  [[nodiscard]] double growth() const { return Spread(simulation_, plane_).growth; }
  // Standard deviation of the particles' velocities [m/s].
  [[nodiscard]] double noise() const {
    const auto& particles = simulation_.particles();
    const Vector<double, 2> mean = mean_of(particles.velocity);
    double squares = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      squares += (particles.velocity.get<Vector<double, 2>>(p) - mean).squaredNorm();
    }
    return std::sqrt(squares / static_cast<double>(particles.size()));
  }

 private:
  Incline plane_{30.0};
  sim::Simulation<2> simulation_;
};

TEST(DefaultViscosity, DampsTheNoiseOfSlidingBlocks) {
  Record record(
      "Default viscosity: noise of blocks that slide down a plane",
      "A block of 200 m x 60 m slides down a plane of 30 degrees for 20 s, at a friction angle of 20 degrees, "
      "on cells that follow the ground. Internal friction is 35 degrees. Without viscosity, noise opens gaps, "
      "and the volume of a block without cohesion grows.",
      "without noise, the volume remains and a block with cohesion moves as a rigid body", "refinement of the cell");
  const std::string usual = "viscosity_number=0.01";
  for (const auto& [cell, growth, undamped] : {std::tuple{20.0, 0.06, 0.12}, {10.0, 0.05, 0.07}, {5.0, 0.03, 0.03}}) {
    const std::string cells = fmt::format(", cells of {} m", cell);
    record.expect_near("growth of the volume without cohesion" + cells, SlidingBlock(cell, 0.0, usual).growth(), 0.0,
                       growth);
    record.expect_near("noise with a cohesion of 250 kPa (m/s)" + cells, SlidingBlock(cell, 2.5e5, usual).noise(), 0.0,
                       1.0);
    EXPECT_GT(SlidingBlock(cell, 0.0, "viscosity_number=0").growth(), undamped);
  }
}

}  // namespace
}  // namespace thawslide::verification

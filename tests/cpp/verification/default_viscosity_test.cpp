// The default viscosity (material.NAME.viscosity_number) damps the noise of sliding blocks on every cell.
#include "../support/following_plane.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// Block of 200 m x 60 m, normal to a plane of 30 degrees, that has slid down for 20 s at a friction angle of 20
// degrees.
class SlidingBlock {
 public:
  explicit SlidingBlock(double cell, const std::string& material = "cohesion=0")
      : simulation_(body_on_plane(
            plane_, cell, {plane_.place(-100, 0), plane_.place(100, 0), plane_.place(100, 60), plane_.place(-100, 60)},
            {"material.rock.youngs_modulus=5e8", "basal.friction_angle=20", "grid.max=[3000,400]",
             "grid.min=[-700,-2000]", "material.rock." + material})) {
    run_until(simulation_, 20.0);
  }

  [[nodiscard]] double growth() const { return volume_growth(simulation_); }
  // Standard deviation of the particles' velocities [m/s].
  [[nodiscard]] double noise() const {
    const auto& particles = simulation_.particles();
    const auto velocity = [&](std::size_t p) { return particles.velocity.get<Vector<double, 2>>(p); };
    const Vector<double, 2> mean(mass_mean(simulation_, [&](auto p) { return velocity(p)[0]; }),
                                 mass_mean(simulation_, [&](auto p) { return velocity(p)[1]; }));
    return root_mean_square(of_particles(simulation_, [&](std::size_t p) { return (velocity(p) - mean).norm(); }));
  }

 private:
  Incline plane_{30.0};
  sim::Simulation<2> simulation_;
};

TEST(DefaultViscosity, DampsTheNoiseOfSlidingBlocks) {
  Record record(
      "Default viscosity: noise of blocks that slide down a plane",
      "A block of 200 m x 60 m slides down a plane of 30 degrees for 20 s, at a friction angle of 20 degrees. "
      "Internal friction is 35 degrees. Without viscosity, noise opens gaps, and the volume of a block without "
      "cohesion "
      "grows.",
      "without noise, the volume remains and a block with cohesion moves as a rigid body", "refinement of the cell");
  for (const auto& [cell, growth] : {std::pair{20.0, 0.07}, {10.0, 0.04}, {5.0, 0.025}}) {
    const std::string cells = fmt::format(", cells of {} m", cell);
    const double loose = SlidingBlock(cell).growth();
    record.expect_near("growth of the volume without cohesion" + cells, loose, 0.0, growth);
    record.expect_near("noise with a cohesion of 250 kPa (m/s)" + cells, SlidingBlock(cell, "cohesion=2.5e5").noise(),
                       0.0, 1.0);
    EXPECT_GT(SlidingBlock(cell, "viscosity_number=0").growth(), 1.5 * loose) << cells;
  }
}

}  // namespace
}  // namespace thawslide::verification

// A slab that breaks along its lowest cells and softens with slip, compared with the motion of a block on that surface.
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double tilt = 20.0, height = 40.0, length = 800.0, end = 6.0;
constexpr double cohesion = 2.2e5, residual = 1.2e5, softening_slip = 1.0;

const Sets slab{"case.gravity_tilt=20; time.end=6; grid.min=[-200,-40]; grid.max=[1400,120]",
                "material.rock.law=mohr_coulomb; material.rock.viscosity_time=0; material.rock.friction_angle=0",
                "material.rock.cohesion=2.2e5; material.rock.residual_cohesion=1.2e5; body.block.shape=polygon",
                "body.block.vertices=[[0.0,0.0],[800.0,0.0],[800.0,40.0],[0.0,40.0]]; body.block.temperature=-5",
                "body.block.porosity=0.3; mechanics.slope_shear=true; basal.friction_angle=60",
                "basal.cohesion=1e8; basal.cohesion_law=constant"};

// Final slip [m] of a slab of thickness `above` [m] on a surface of the strength
//   c = c_f + (c_0 - c_f) exp(-s/s_c),     rho above s'' = rho g above sin(tilt) - c
double slip_of_block(double density, double above) {
  constexpr int steps = 6000;
  constexpr double dt = end / steps;
  double slip = 0.0, speed = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double strength = residual + (cohesion - residual) * std::exp(-slip / softening_slip);
    speed += dt * (gravity * std::sin(tilt * degree) - strength / (density * above));
    slip += dt * speed;
  }
  return slip;
}

// Slip of the middle of the slab, above the breaking cells, relative to that of the block. These cells stick to the
// ground at their lower face. The surface of rupture is assumed at their mid-height.
double slip_over_exact(double cell, const std::string& softening) {
  const Sets sets = fmt::format("grid.cell={}; time.step={}; {}", cell, 6e-4 * cell, softening);
  Simulation<2> simulation(base_case("block", slab + sets));
  const double density = simulation.particles().mass(0) / simulation.particles().volume(0);  // at the start
  run_until(simulation, end);
  const auto& particles = simulation.particles();
  const Vector<double, 2> origin = simulation.model().origin;
  double mass = 0.0, moment = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double slipped = particles.displacement(p, 0);
    const double x = particles.position(p, 0) + origin[0] - slipped;
    const double y = particles.position(p, 1) + origin[1] - particles.displacement(p, 1);
    if (std::abs(x - 0.5 * length) < 150.0 && y > cell) {
      mass += particles.mass(p);
      moment += particles.mass(p) * slipped;
    }
  }
  return moment / mass / slip_of_block(density, height - 0.5 * cell);
}

TEST(SofteningSlab, SlipsAsABlockOnASurfaceThatSoftensOverASlip) {
  Record record(
      "Slab that softens over a slip",
      "A slab 40 m thick and 800 m long sticks to its ground, tilted by 20 degrees. Its lowest cells break and "
      "lose cohesion from 220 to 120 kPa over a slip of 1 m.",
      "slip s of the middle after 6 s: rho (H - h/2) s'' = rho g (H - h/2) sin a - c_f - (c_0 - c_f) "
      "exp(-s/s_c)",
      "momentum of a block on that surface");
  const double coarse = slip_over_exact(10.0, "material.rock.softening_slip=1.0");
  const double fine = slip_over_exact(5.0, "material.rock.softening_slip=1.0");
  record.expect_near("slip over exact, cells of 10 m", coarse, 1.0, 0.08);
  record.expect_near("slip over exact, cells of 5 m", fine, 1.0, 0.04);
  EXPECT_LT(1.0 - fine, 0.6 * (1.0 - coarse)) << "the error decreases in first order of the cell";
  // Softening strain equivalent to this slip on cells of 10 m.
  const double of_strain = slip_over_exact(5.0, "material.rock.softening_strain=0.057735");
  EXPECT_GT(of_strain, 1.04) << "half of the slip breaks cells of half the size";
}

}  // namespace
}  // namespace thawslide::verification

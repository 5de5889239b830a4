// Pore pressure of melted material: manufactured diffusion with spatially variable porosity, undrained heating, and
// diffusion to a drained top.
#include <utility>

#include "../exact/water.hpp"
#include "physics/pressurization.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// A melted square without weight, sealed except at its top, of uniform temperature.
const Sets square{"case.gravity=0; time.end=400; grid.max=[1,1.2]; material.soil.hydraulic_conductivity=1e-9",
                  "body.column.max=[1,1]; body.column.temperature=1; heat.enabled=false",
                  "body.column.porosity={ x = [0.0, 1.0], value = [0.2, 0.6] }"};

// P = A (2 + cos pi x) cos^2(pi y/2) exp(-t/tau): no flow through x = 0, x = 1 and y = 0. At the drained top y = 1, P
// and its gradient vanish, because P = 0 acts on the whole upper half of a cell.
//   n dP/dt = div(K_L k_L/gamma_w grad P) + n source                                         Eqs. 8 and 23
struct Manufactured {
  static constexpr double scale = 1e6, decay = 500.0;
  double mobility;  // K_L k_L/gamma_w [m2/s]

  [[nodiscard]] static double along(double x) { return 2.0 + std::cos(pi * x); }
  [[nodiscard]] static double up(double y) { return 0.5 + 0.5 * std::cos(pi * y); }
  [[nodiscard]] static double pressure(double x, double y, double t) {
    return scale * along(x) * up(y) * std::exp(-t / decay);
  }
  // [Pa/s] at porosity n
  [[nodiscard]] double source(double x, double y, double t, double n) const {
    const double square = pi * pi;
    const double laplacian =
        -scale * std::exp(-t / decay) * square * (std::cos(pi * x) * up(y) + along(x) * 0.5 * std::cos(pi * y));
    return -pressure(x, y, t) / decay - mobility / n * laplacian;
  }
};

double error_on(double cell, Curve* curve) {
  const Sets of_cell = fmt::format("grid.cell={}; time.step={}", cell, 4.0 * cell * cell / 0.01);
  Simulation<2> simulation(published_case("column", square + of_cell));
  const auto& phases = simulation.model().motion.phases;
  const Manufactured exact{phases.water_bulk_modulus * 1e-9 / phases.water_unit_weight};
  const auto set = [](auto& particles, std::size_t p, double value) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = value;
  };
  auto& at_start = simulation.particles();
  for (std::size_t p = 0; p < at_start.size(); ++p) {
    set(at_start, p, Manufactured::pressure(at_start.position(p, 0), at_start.position(p, 1), 0.0));
  }
  while (simulation.time() < 400.0 * (1.0 - 1e-12)) {
    const double dt = simulation.next_step(400.0);
    const double middle = simulation.time() + 0.5 * dt;
    simulation.step(dt);
    auto& particles = simulation.particles();  // reread: a device may have modified them
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double source =
          exact.source(particles.position(p, 0), particles.position(p, 1), middle, particles.porosity(p));
      set(particles, p, particles.pore_pressure(p) + dt * source);
    }
  }
  const auto& particles = std::as_const(simulation).particles();
  return root_mean_square(of_particles(std::as_const(simulation), [&](std::size_t p) {
    const double x = particles.position(p, 0), y = particles.position(p, 1), found = particles.pore_pressure(p) / 1e6;
    const double expected = Manufactured::pressure(x, y, 400.0) / 1e6;
    if (curve != nullptr && x < 0.5 * cell) {
      add_point(*curve, y, found, expected);
    }
    return found - expected;
  }));
}

TEST(PorePressure, Manufactured) {
  Record record("Diffusion of pore pressure, manufactured",
                "A melted square, sealed except at its top, whose porosity rises from 0.2 to 0.6 along x, with a "
                "source that makes a given pressure field exact.",
                "P = A (2 + cos pi x) cos^2(pi y/2) exp(-t/500)", "method of manufactured solutions, Roache 2002");
  const std::vector<double> cells{0.1, 0.05, 0.025};
  const std::vector<double> errors =
      errors_with_curve(record, cells, 0.1, {"y [m]", "pressure at x = 0 [MPa]", {}, {}, {}}, error_on);
  record.expect_order("cell [m]", cells, "rms error of pressure [MPa]", errors, 2.0, 0.1);
}

// A melted column one cell wide and 1 m high, without weight.
const Sets column{"case.gravity=0; time.end=700; grid.cell=0.1; grid.max=[1,2]; body.column.max=[0.1,1]",
                  "body.column.temperature=1"};

TEST(UndrainedHeating, PressureRisesInProportionToTemperature) {
  Record record("Undrained heating",
                "A melted bar heated at its end; the rock's expansion is a hundred times larger than real, so that the "
                "porosity falls as it warms.",
                "P - P0 = K_L {beta_S I + (beta_L - beta_S)(T - T0)}, I = integral of dT/n",
                "Eqs. 6 and 8, integrated");
  const std::vector<double> steps{8.0, 4.0, 2.0, 1.0};
  const std::vector<double> errors = each_of(steps, [](double dt) {
    const Sets heated{"phases.rock_expansion=3e-3; pressure.seepage=false; time.end=8000",
                      fmt::format("heat.boundary.y_min={{flux=400.0}}; time.step={}", dt)};
    Simulation<2> simulation(published_case("column", column + heated));
    run_until(simulation, 8000.0);
    const auto& particles = std::as_const(simulation).particles();
    const auto& phases = simulation.model().motion.phases;
    return greatest_of(std::as_const(simulation), [&](std::size_t p) {
      const double expected =
          physics::exact::undrained_pressure_rise(particles.temperature(p) - 1.0, 0.375, phases.water_bulk_modulus,
                                                  phases.rock_expansion, phases.water_expansion);
      return std::abs(particles.liquid_pressure(p) - expected) / 1e6;
    });
  });
  record.expect_order("step [s]", steps, "largest error of pressure [MPa]", errors, 1.0, 0.05);
}

TEST(Consolidation, OfAMeltedColumn) {
  Record record("Diffusion of pore pressure", "A melted column at 1 MPa, drained at its top, on a sealed base.",
                "sum of sin(M z/H) exp(-M^2 D t/H^2)", "Terzaghi 1943");
  const std::vector<double> cells{0.2, 0.1, 0.05, 0.025};
  const Curve profile{"depth below the top [m]", "pressure [MPa]", {}, {}, {}};
  const std::vector<double> errors = errors_with_curve(record, cells, 0.1, profile, [](double cell, Curve* curve) {
    const Sets of_cell{fmt::format("grid.cell={0}; body.column.max=[{0},1]", cell),
                       fmt::format("time.step={}", 4.0 * cell * cell / 0.01),
                       "material.soil.hydraulic_conductivity=1e-9"};
    Simulation<2> simulation(published_case("column", column + of_cell));
    auto& at_start = simulation.particles();
    for (std::size_t p = 0; p < at_start.size(); ++p) {
      at_start.liquid_pressure(p) = at_start.pore_pressure(p) = 1e6;
    }
    run_until(simulation, 700.0);
    const auto& particles = std::as_const(simulation).particles();  // reread: a device may have modified them
    const double diffusivity = physics::hydraulic_diffusivity(simulation.model().motion.phases, 0.375, 1.0, 1e-9);
    return root_mean_square(of_particles(std::as_const(simulation), [&](std::size_t p) {
      const double depth = 1.0 - particles.position(p, 1), found = particles.pore_pressure(p) / 1e6;
      const double exact = physics::exact::consolidation_pressure(depth, 1.0, diffusivity, 700.0);
      if (curve != nullptr && particles.position(p, 0) < 0.5 * cell) {
        add_point(*curve, depth, found, exact);
      }
      return found - exact;
    }));
  });
  record.expect_order("cell [m]", cells, "rms error of pressure [MPa]", errors, 1.0, 0.1);
  record.explain(
      "The pressure of the free surface acts on all particles in the upper half of the top cell. The drained boundary "
      "is therefore a fraction of a cell below the top. The manufactured field above, without this effect, is of order "
      "2.");
}

}  // namespace
}  // namespace thawslide::verification

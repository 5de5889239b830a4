// Manufactured diffusion of pore pressure: a source makes a given field exact, with spatially variable porosity.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "../support/case_from_text.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

// A melted square without weight, sealed except at its top, of uniform temperature.
const std::string square = R"(
[case]
gravity = 0.0
[time]
end = 400.0
step = 4.0
[grid]
cell = 0.1
min = [0.0, 0.0]
max = [1.0, 1.2]
[material.soil]
law = "elastic"
hydraulic_conductivity = 1e-9
[body.soil]
material = "soil"
min = [0.0, 0.0]
max = [1.0, 1.0]
temperature = 1.0
porosity = { x = [0.0, 1.0], value = [0.2, 0.6] }
[mechanics]
enabled = false
[heat]
enabled = false
)";

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
  Simulation<2> simulation(
      paper_case(square, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 4.0 * cell * cell / 0.01)}));
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
  std::vector<double> errors;
  const auto& particles = std::as_const(simulation).particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position(p, 0), y = particles.position(p, 1);
    const double expected = Manufactured::pressure(x, y, 400.0) / 1e6;
    errors.push_back(particles.pore_pressure(p) / 1e6 - expected);
    if (curve != nullptr && x < 0.5 * cell) {
      curve->x.push_back(y);
      curve->computed.push_back(particles.pore_pressure(p) / 1e6);
      curve->exact.push_back(expected);
    }
  }
  return root_mean_square(errors);
}

TEST(PorePressure, Manufactured) {
  Record record("Diffusion of pore pressure, manufactured",
                "A melted square, sealed except at its top, whose porosity rises from 0.2 to 0.6 along x, with a "
                "source that makes a given pressure field exact.",
                "P = A (2 + cos pi x) cos^2(pi y/2) exp(-t/500)", "method of manufactured solutions, Roache 2002");
  const std::vector<double> cells{0.1, 0.05, 0.025};
  Curve curve{"y [m]", "pressure at x = 0 [MPa]", {}, {}, {}};
  std::vector<double> errors;
  for (const double cell : cells) {
    errors.push_back(error_on(cell, cell == 0.1 ? &curve : nullptr));
  }
  record.draw(curve);
  record.expect_order("cell [m]", cells, "rms error of pressure [MPa]", errors, 2.0, 0.1);
}

}  // namespace
}  // namespace thawslide::verification

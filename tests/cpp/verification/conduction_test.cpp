// Heat conduction without motion: half space, two layers, and a manufactured solution with melting.
#include "../exact/heat.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// A melted bar of 4 m at rest, of two porosities; the sides are insulated unless --set specifies otherwise.
const Sets insulated{"grid.max=[4,1]; phases.rock_expansion=0"};

// Assigns temperatures to particles, with the corresponding heat content and saturation.
template <class Temperature>
void set_temperatures(Simulation<2>& simulation, const Temperature& temperature) {
  auto& particles = simulation.particles();
  simulation.model().band.with_heat_content([&](const auto& content) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.temperature(p) = temperature(particles.position(p, 0), particles.position(p, 1));
      particles.heat_content(p) = content.content(particles.temperature(p), particles.initial_porosity(p));
      particles.liquid_saturation(p) = content.curve.saturation(particles.temperature(p));
    }
  });
}

// Root mean square errors of temperature over a bar [K].
struct Errors {
  double all;
  double away;  // at least 0.4 m from the middle
};

// Final state of the bar, on cells of a given size, with time steps proportional to the square of the cell size. The
// run begins with the exact temperatures at a time `start` after t = 0 of the exact solution, or as in the case if
// `start` is 0.
template <class Exact>
Errors errors_on(double cell, double start, const Sets& sets, const Exact& exact, Curve* curve) {
  const Sets of_cell =
      fmt::format("grid.cell={0}; time.step={1}; body.bar.max=[4,{0}]", cell, 1000.0 * cell * cell / 0.01);
  Simulation<2> simulation(published_case("bar", insulated + sets + of_cell));
  if (start > 0.0) {
    set_temperatures(simulation, [&](double x, double /*y*/) { return exact(simulation, x, start); });
  }
  run_until(simulation, simulation.parameters().time.end);
  const auto& particles = simulation.particles();
  std::vector<double> away;
  const std::vector<double> all = of_particles(simulation, [&](std::size_t p) {
    const double x = particles.position(p, 0), expected = exact(simulation, x, start + simulation.time());
    if (std::abs(x - 2.0) > 0.4) {
      away.push_back(particles.temperature(p) - expected);
    }
    if (curve != nullptr && particles.position(p, 1) < 0.5 * cell) {
      add_point(*curve, x, particles.temperature(p), expected);
    }
    return particles.temperature(p) - expected;
  });
  return {root_mean_square(all), root_mean_square(away)};
}

const std::vector<double> cells{0.2, 0.1, 0.05};
const Curve profile{"x [m]", "temperature [C]", {}, {}, {}};

TEST(Conduction, HalfSpace) {
  Record record("Heat conduction into a half space", "A bar at 2 C whose end is kept at 8 C.",
                "T = T0 + (Ts - T0) erfc(x/sqrt(4 a t))", "Carslaw and Jaeger 1959, ch. 2");
  const auto exact = [](const Simulation<2>& simulation, double x, double t) {
    const auto& phases = simulation.model().motion.phases;
    const double diffusivity = physics::conductivity(phases, 0.375, 1.0) / physics::heat_capacity(phases, 0.375, 1.0);
    return physics::exact::half_space_temperature(x, t, 2.0, 8.0, diffusivity);
  };
  const std::vector<double> errors = errors_with_curve(record, cells, 0.1, profile, [&](double cell, Curve* curve) {
    return errors_on(cell, 0.0, "heat.boundary.x_min={temperature=8.0}", exact, curve).all;
  });
  record.expect_order("cell [m]", cells, "rms error of temperature [K]", errors, 2.0, 0.1);
}

// Two half spaces in contact at x = 2 m, at a cell border.
double two_layers(const Simulation<2>& simulation, double x, double t) {
  const auto& phases = simulation.model().motion.phases;
  const auto side = [&](double porosity, double temperature) {
    return physics::exact::HalfSpace{physics::conductivity(phases, porosity, 1.0),
                                     physics::heat_capacity(phases, porosity, 1.0), temperature};
  };
  return physics::exact::two_half_spaces_temperature(x - 2.0, t, side(0.1, 8.0), side(0.9, 2.0));
}

Errors two_layers_on(double cell, const std::string& update, Curve* curve) {
  return errors_on(cell, 4e4,
                   {"time.end=6e4", "heat.update=" + update,
                    "body.bar.temperature={x=[0.0,1.9999,2.0001,4.0],value=[8.0,8.0,2.0,2.0]}",
                    "body.bar.porosity={x=[0.0,1.9999,2.0001,4.0],value=[0.1,0.1,0.9,0.9]}"},
                   two_layers, curve);
}

TEST(Conduction, TwoLayers) {
  Record record("Two layers of different conductivity",
                "Layers of porosity 0.1 at 8 C and 0.9 at 2 C, from 4e4 s after they touched; the interface lies where "
                "cells meet.",
                "T = Ti + (Tj - Ti) erf(|x|/sqrt(4 a_j t)), Ti from sqrt(k C) of both",
                "Carslaw and Jaeger 1959, ch. 2");
  const std::vector<double> errors = errors_with_curve(record, cells, 0.1, profile, [](double cell, Curve* curve) {
    return two_layers_on(cell, "enthalpy", curve).all;
  });
  const std::vector<double> finer{0.1, 0.05, 0.025};
  std::vector<double> plain_all, plain_away;
  for (const double cell : finer) {
    const Errors plain = two_layers_on(cell, "apparent_capacity", nullptr);
    plain_all.push_back(plain.all);
    plain_away.push_back(plain.away);
  }
  record.expect_order("cell [m]", cells, "rms error of temperature [K]", errors, 1.0, 0.15);
  record.expect_order("cell [m]", finer, "apparent capacity, no subgrid diffusion: rms error [K]", plain_all, 1.5,
                      0.15);
  record.expect_order("cell [m]", finer,
                      "apparent capacity, no subgrid diffusion: rms error 0.4 m and more from the interface [K]",
                      plain_away, 2.0, 0.1);
  record.explain(
      "The interface's node averages over a kink of the temperature, so the particles of two cells are off in first "
      "order: 1.5 in the rms over all. Away from it conduction alone is of order 2. Subgrid diffusion treats the kink "
      "as a difference that nodes do not resolve, and moves heat across an interface of unequal capacities: order 1.");
}

// T = mean + amplitude cos(pi x/L) cos(pi y/L) exp(-t/tau) in an insulated square below freezing. Capacity (with latent
// heat) and conductivity depend on temperature. The source that makes the solution exact is added to the heat content
// of particles between steps.
struct Manufactured {
  static constexpr double side = 2.0, mean = -2.0, amplitude = 1.5, decay = 4e5, end = 8e4;

  [[nodiscard]] static double temperature(double x, double y, double t) {
    const double k = pi / side;
    return mean + amplitude * std::cos(k * x) * std::cos(k * y) * std::exp(-t / decay);
  }
  // (C + rho_I n L_f dS/dT) dT/dt - div(k grad T) [W/m3]
  template <class Content>
  [[nodiscard]] static double source(const Content& content, double porosity, double x, double y, double t) {
    const double k = pi / side;
    const double shrink = amplitude * std::exp(-t / decay);
    const double here = temperature(x, y, t);
    const double gradient2 = std::pow(shrink * k, 2) * (std::pow(std::sin(k * x) * std::cos(k * y), 2) +
                                                        std::pow(std::cos(k * x) * std::sin(k * y), 2));
    const auto curve = content.curve.at(here);
    const auto& phases = content.phases;
    const double slope = porosity * (phases.water_conductivity - phases.ice_conductivity) * curve.derivative;
    return -content.apparent_capacity(here, porosity) * (here - mean) / decay +
           physics::conductivity(phases, porosity, curve.saturation) * 2.0 * k * k * (here - mean) - slope * gradient2;
  }
};

double manufactured_error(double cell) {
  const Sets square =
      fmt::format("grid.max=[2,2]; body.bar.max=[2,2]; grid.cell={}; time.step={}", cell, 256.0 * cell * cell / 0.01);
  Simulation<2> simulation(published_case("bar", insulated + square + "time.end=8e4; freezing.exponent=2"));
  return simulation.model().band.with_heat_content([&](const auto& content) {
    const auto set_heat = [&](auto& of, std::size_t p, double heat) {
      of.heat_content(p) = heat;
      of.temperature(p) = content.temperature(heat, of.initial_porosity(p), of.temperature(p));
      of.liquid_saturation(p) = content.curve.saturation(of.temperature(p));
    };
    auto& at_start = simulation.particles();
    for (std::size_t p = 0; p < at_start.size(); ++p) {
      const double start = Manufactured::temperature(at_start.position(p, 0), at_start.position(p, 1), 0.0);
      set_heat(at_start, p, content.content(start, at_start.initial_porosity(p)));
    }
    while (simulation.time() < Manufactured::end * (1.0 - 1e-12)) {
      const double dt = simulation.next_step(Manufactured::end);
      const double middle = simulation.time() + 0.5 * dt;
      simulation.step(dt);
      auto& particles = simulation.particles();  // reread: a device may have modified them
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const double power = Manufactured::source(content, particles.initial_porosity(p), particles.position(p, 0),
                                                  particles.position(p, 1), middle);
        set_heat(particles, p, particles.heat_content(p) + dt * power);
      }
    }
    const auto& particles = simulation.particles();
    return root_mean_square(of_particles(simulation, [&](std::size_t p) {
      return particles.temperature(p) -
             Manufactured::temperature(particles.position(p, 0), particles.position(p, 1), Manufactured::end);
    }));
  });
}

TEST(Conduction, ManufacturedWithMelting) {
  Record record("Conduction with partial melting, manufactured",
                "An insulated square whose ice melts and freezes, with a source of heat that makes a given temperature "
                "field exact; capacity, latent heat and conductivity follow the temperature.",
                "T = -2 + 1.5 cos(pi x/2) cos(pi y/2) exp(-t/4e5)", "method of manufactured solutions, Roache 2002");
  const std::vector<double> sizes{0.25, 0.125, 0.0625};
  record.expect_order("cell [m]", sizes, "rms error of temperature [K]", each_of(sizes, manufactured_error), 2.0, 0.1);
}

}  // namespace
}  // namespace thawslide::verification

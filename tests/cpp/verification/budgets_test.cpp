// Budgets: heat is conserved while ice melts in an insulated body and with heat from friction. The mechanical energy of
// the first seconds on the incline is complete; the 25 s are in tests/cpp/long.
#include <utility>

#include "../support/fields.hpp"
#include "incline_energy.hpp"

namespace thawslide::verification {
namespace {

const Sets melting{"time.end=2e7; time.step=1e4; grid.cell=0.5; grid.max=[10,5]; body.bar.max=[10,5]",
                   "body.bar.temperature={ x = [0.0, 4.99, 5.01, 10.0], value = [30.0, 30.0, -3.0, -3.0] }"};

// Heat that particles have exchanged since the start [J].
double heat_moved(const Simulation<2>& simulation, const std::vector<double>& start) {
  const auto& particles = simulation.particles();
  double moved = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    moved += 0.5 * particles.initial_volume(p) *
             std::abs(particles.heat_content(p) - start[static_cast<std::size_t>(particles.id(p))]);
  }
  return moved;
}

TEST(HeatBudget, ClosesDuringMelting) {
  Record record("Heat of an insulated body that melts", "One half of a body, at 30 C, melts the other half, at -3 C.",
                "the heat content does not change", "energy balance");
  for (const std::string curve : {"power_law", "linear"}) {
    Simulation<2> simulation(published_case("bar", melting + ("freezing.curve=" + curve)));
    const auto ice = [&] {
      const auto& particles = std::as_const(simulation).particles();
      return mass_mean(std::as_const(simulation), [&](auto p) { return 1.0 - particles.liquid_saturation(p); });
    };
    const std::vector<double> start = fields_by_id(std::as_const(simulation).particles()).at("heat_content");
    const double at_start = ice();
    run_until(simulation, 2e7);
    EXPECT_LT(ice(), 0.9 * at_start) << "ice must have melted for this to say much";
    record.expect_near("residual over heat moved, " + curve,
                       value_of(history_row(simulation), "thermal_residual_J") / heat_moved(simulation, start), 0.0,
                       1e-12);
  }
}

// A melted column whose temperature and pore pressure both decrease towards the top.
const Sets seeping{"case.gravity=0; time.end=4000; time.step=1; grid.cell=0.05; grid.max=[0.5,1.2]",
                   "material.soil.hydraulic_conductivity=1e-9; body.column.max=[0.05,1]; body.column.temperature=25"};

TEST(HeatBudget, ReportsTheHeatCreatedByAdvection) {
  Record record("Heat of a melted column through which water seeps",
                "Water seeps up an insulated, melted column as its pressure drains; the advection term of Eq. 9 is not "
                "in conservation form.",
                "the heat content changes by the heat created, at first rho_L C_L (k_L/gamma_w) grad P . grad T over "
                "the volume; not at all without the term",
                "energy balance");
  for (const bool on : {true, false}) {
    Simulation<2> simulation(published_case("column", seeping + fmt::format("heat.advection={}", on)));
    auto& particles = simulation.particles();
    const auto before = history_row(simulation);
    double stirred = 0.0;
    simulation.model().band.with_heat_content([&](const auto& content) {
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const double wave = std::cos(pi * particles.position(p, 1));
        particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e6 * (1.0 + wave);
        particles.temperature(p) = 25.0 + 20.0 * wave;
        const double old = particles.heat_content(p);
        particles.heat_content(p) = content.content(particles.temperature(p), particles.initial_porosity(p));
        stirred += particles.initial_volume(p) * (particles.heat_content(p) - old);
      }
    });
    const std::vector<double> start = fields_by_id(std::as_const(simulation).particles()).at("heat_content");
    simulation.step(1.0);
    const double first = value_of(history_row(simulation), "advection_J");
    run_until(simulation, 4000.0);
    const auto row = history_row(simulation);
    const std::string with = on ? "on" : "off";
    const double made = value_of(row, "advection_J");
    const double gained = value_of(row, "sensible_J") + value_of(row, "latent_J") - value_of(before, "sensible_J") -
                          value_of(before, "latent_J") - stirred;
    record.expect_near("advection " + with + ": heat gained less what the term made, over heat moved",
                       (gained - made) / heat_moved(simulation, start), 0.0, 1e-12);
    if (on) {
      const auto& phases = simulation.model().motion.phases;
      const double exact = phases.water_density * phases.water_heat_capacity * 1e-9 / phases.water_unit_weight * 1e6 *
                           20.0 * 0.5 * pi * pi * 0.05;
      record.expect_near("advection on: heat made in the first step over exact", first / exact, 1.0, 0.02);
    } else {
      record.expect_near("advection off: heat made", made, 0.0, 0.0);
    }
  }
}

const Sets braking{"time.end=2; time.step=0.002; material.rock.poisson_ratio=0; body.block.temperature=-0.2",
                   "body.block.velocity=[20,0]; basal.heat_fraction=0.35; band.thickness=0.05",
                   "heat.enabled=true; pressure.enabled=true"};

TEST(HeatBudget, FrictionHeatsTheSlide) {
  Record record("Friction work becomes heat", "A block of rock and ice brakes on level ground and melts at its base.",
                "work of friction = kinetic energy lost; 0.35 of it is heat in the block", "energy balance");
  Simulation<2> simulation(published_case("block", braking));
  const auto before = history_row(simulation);
  run_until(simulation, 2.0);
  const auto row = history_row(simulation);
  const double work = value_of(row, "friction_work_J");
  const double heat = value_of(row, "friction_heat_J");
  const auto warmth = [](const auto& of) { return value_of(of, "sensible_J") + value_of(of, "latent_J"); };
  EXPECT_GT(value_of(row, "latent_J"), value_of(before, "latent_J"));
  record.expect_near("heat over work", heat / work, 0.35, 1e-13);
  record.expect_near("warmth gained in the block over friction heat", (warmth(row) - warmth(before)) / heat, 1.0,
                     1e-12);
  record.expect_near("(work - heat - converted) over work", (work - heat - value_of(row, "converted_J")) / work, 0.0,
                     1e-13);
  const double lost = value_of(before, "kinetic_J") - value_of(row, "kinetic_J");
  record.expect_near("work over kinetic energy lost", work / lost, 1.0, 5e-3);
}

TEST(InclineEnergy, ResidualIsOfFirstOrderInTheStep) {
  Record record(
      "Mechanical energy budget on the incline, the first 2 s",
      "Cases D, D-L, D-L-P and P-L of Sec. 3.3: mechanical_residual_J over the work of gravity and the size of "
      "the friction work; asserted below 1 % with each step.",
      "no energy remains except the error of time integration", "energy balance");
  expect_closed_budget(record, 2.0, 0.15);
}

}  // namespace
}  // namespace thawslide::verification

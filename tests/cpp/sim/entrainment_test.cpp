// Entrainment of an erodible bed, with every mechanism: balances, remaining bed, and bitwise identical results for any
// number of threads and after a restart.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "../support/messages.hpp"
#include "../support/reproducible_runs.hpp"
#include "../support/two_bodies.hpp"
#include "band/basal_segments.hpp"
#include "sim/block/block.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim>
constexpr int steps = Dim == 2 ? 150 : 60;

template <int Dim>
config::Case slide_over_bed(const Sets& sets) {
  return two_bodies<Dim>(5e3, Dim == 2 ? 20.0 : 8.0, 5.0, 20.0, loose_bed() + sets);
}

// Residual of the mechanical budget relative to the initial kinetic energy.
template <int Dim>
double work_residual(const Simulation<Dim>& simulation) {
  return std::abs(value_of(history_row(simulation), "mechanical_residual_J")) /
         (0.5 * simulation.budget().initial_mass * 400.0);
}

template <int Dim>
void expect_valid_runs(const Sets& sets) {
  const config::Case parameters = slide_over_bed<Dim>(sets);
  const auto visit = [](Simulation<Dim>& simulation, int step) {
    expect_closed_budgets(simulation);
    const HistoryRow row = history_row(simulation);
    const auto value = [&](const std::string& name) { return value_of(row, name); };
    const double mass = simulation.budget().initial_mass;
    EXPECT_NEAR((value("mass_kg") - mass - (value("entrained_mass_kg") - value("loose_mass_kg"))) / mass, 0.0, 1e-13);
    EXPECT_LT(work_residual(simulation), 2e-4);  // of first order: MechanicalBudgetClosesInFirstOrderOfTheStep
    EXPECT_NEAR(value("bed_residual_kg") / mass, 0.0, 1e-13);
    EXPECT_NEAR(value("bed_residual_J") / (0.5 * mass * 400.0), 0.0, 1e-13);
    for (const double left : simulation.bed()->left()) {
      EXPECT_GE(left, 0.0);
    }
    EXPECT_TRUE(step < steps<Dim> ||
                simulation.particles().size() > simulation.particles_at_start() + (Dim == 2 ? 10 : 20));
  };
  expect_reproducible_run<Dim>([&] { return std::make_unique<Simulation<Dim>>(parameters); }, steps<Dim>,
                               {{2, 7, -1}, {2, 3, steps<Dim> / 2}}, visit);
}

TEST(Entrainment, BalancesCloseAndResultsAreReproducibleInThePlane) {
  expect_valid_runs<2>({"bed.law=momentum"});
  expect_valid_runs<2>({"bed.law=strength"});
}
TEST(Entrainment, BalancesCloseAndResultsAreReproducibleInSpace) { expect_valid_runs<3>({"bed.law=strength"}); }
TEST(Entrainment, BalancesCloseAndResultsAreReproducibleWithOtherChoices) {
  expect_valid_runs<2>("bed.law=strength; mechanics.transfer=apic; time.stepping=adaptive");
  expect_valid_runs<2>(
      "bed.law=strength; band.model=columns; heat.advection_form=conservative; "
      "band.thickness_change=conserving; pressure.frozen=none; pressure.frozen_rows=vented; "
      "pressure.melt_contraction=true; body.right.material=frozen");
  expect_valid_runs<2>("bed.law=momentum; mechanics.effective_stress=true; pressure.thickness_update=frozen");
}

// The work of entrainment is in the budget to round-off (bed_residual_J). The remaining residual is that of time
// integration.
TEST(Entrainment, MechanicalBudgetClosesInFirstOrderOfTheStep) {
  for (const std::string law : {"momentum", "strength"}) {
    std::array<double, 3> left_over{};
    for (std::size_t k = 0; k < left_over.size(); ++k) {
      const int finer = 1 << k;
      Simulation<2> simulation(slide_over_bed<2>({"bed.law=" + law, fmt::format("time.step={}", 0.0005 / finer)}));
      for (int step = 0; step < 2 * steps<2> * finer; ++step) {
        simulation.step(simulation.next_step(1.0));
        left_over[k] = std::max(left_over[k], work_residual(simulation));
      }
    }
    EXPECT_NEAR(std::log2(left_over[0] / left_over[1]), 1.0, 0.2) << law;
    EXPECT_NEAR(std::log2(left_over[1] / left_over[2]), 1.0, 0.2) << law;
  }
}

// Entrained material is warmer than the bed was, by the kinetic energy that the slide loses to it.
TEST(Entrainment, HeatsEntrainedMaterialByTheLostKineticEnergy) {
  const config::Case parameters = slide_over_bed<2>("bed.law=strength; bed.temperature=-20.0");
  Simulation<2> simulation(parameters);
  for (int k = 0; k < steps<2>; ++k) {
    simulation.step(0.002);
  }
  const HistoryRow row = history_row(simulation);
  const double joined = value_of(row, "entrained_mass_kg") - value_of(row, "loose_mass_kg");
  const double per_mass = value_of(row, "entrained_heat_J") / joined;
  EXPECT_GT(per_mass, 0.4 * 18.0 * 18.0);  // about v2/2 of material that moves at 20 m/s
  EXPECT_LT(per_mass, 0.6 * 21.0 * 21.0);
}

TEST(Entrainment, TheBlockModelRefusesABed) {
  expect_in(error_of([] { run_block(slide_over_bed<2>("bed.law=strength")); }),
            "the block model does not entrain a bed. Remove [bed], or use `thawslide run`.");
}

}  // namespace
}  // namespace thawslide::sim

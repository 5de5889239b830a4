// Entrainment of an erodible bed, with every mechanism: balances, remaining bed, and bitwise identical results for any
// number of threads and after a restart.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "../support/fields.hpp"
#include "../support/messages.hpp"
#include "../support/two_bodies.hpp"
#include "band/basal_segments.hpp"
#include "base/parallel.hpp"
#include "io/checkpoint.hpp"
#include "sim/block.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim>
constexpr int steps = Dim == 2 ? 150 : 60;

template <int Dim>
config::Case slide_over_bed(const Sets& sets) {
  return two_bodies<Dim>(5e3, Dim == 2 ? 20.0 : 8.0, 5.0, 20.0, loose_bed() + sets);
}

// Final state of the run, and maxima recorded during the run.
struct Seen {
  std::map<std::string, std::vector<double>> state;
  HistoryRow row;
  double mass = 0.0, momentum = 0.0, heat = 0.0, work = 0.0, bed = 0.0;  // maximum relative residuals of the budgets
  double smallest = 0.0;                                                 // remaining mass below any column [kg]
  std::size_t joined = 0;
};

template <int Dim>
void record_residuals(const Simulation<Dim>& simulation, Seen& seen) {
  const HistoryRow row = history_row(simulation);
  const double mass = simulation.budget().initial_mass;
  const auto value = [&](const std::string& name) { return value_of(row, name); };
  const auto warning = [](double& largest, double fraction) { largest = std::max(largest, std::abs(fraction)); };
  warning(seen.mass, value("mass_residual_kg") / mass);
  warning(seen.mass, (value("mass_kg") - mass - (value("entrained_mass_kg") - value("loose_mass_kg"))) / mass);
  for (const std::string axis : Dim == 2 ? std::vector{"x", "y"} : std::vector{"x", "y", "z"}) {
    warning(seen.momentum, value("momentum_residual_" + axis + "_N_s") / (mass * 20.0));
  }
  warning(seen.heat, value("thermal_residual_J") / (std::abs(value("sensible_J")) + value("latent_J")));
  warning(seen.work, value("mechanical_residual_J") / (0.5 * mass * 400.0));
  warning(seen.bed, value("bed_residual_kg") / mass);
  warning(seen.bed, value("bed_residual_J") / (0.5 * mass * 400.0));
  for (const double left : simulation.bed()->left()) {
    seen.smallest = std::min(seen.smallest, left);
  }
}

// stop: time step before which the run stops and resumes from its checkpoint; -1: no stop.
template <int Dim>
Seen run(const Sets& sets, int threads, int interval, int stop) {
  const int threads_before = thread_count();
  set_thread_count(threads);
  const config::Case parameters = slide_over_bed<Dim>(sets);
  auto simulation = std::make_unique<Simulation<Dim>>(parameters);
  simulation->set_sorting_interval(interval);
  Seen seen;
  for (int k = 0; k < steps<Dim>; ++k) {
    if (k == stop) {
      const auto folder = folder_of_this_test();
      NamedNumbers blocks{{"bed", simulation->bed()->state()}};
      if (const auto* columns = simulation->band_columns()) {
        blocks["band_columns"] = columns->state();
      }
      io::write_checkpoint<Dim>(folder, simulation->particles(), simulation->particles_at_start(),
                                simulation->scalars(), blocks);
      simulation = std::make_unique<Simulation<Dim>>(parameters);
      simulation->set_sorting_interval(interval);
      std::vector<double> scalars;
      blocks = io::read_checkpoint<Dim>(io::newest_checkpoint(folder), simulation->particles(), scalars);
      simulation->restore(scalars);
      simulation->restore_bed(blocks.at("bed"));
      if (simulation->band_columns() != nullptr) {
        simulation->restore_band_columns(blocks.at("band_columns"));
      }
    }
    simulation->step(simulation->next_step(1.0));
    record_residuals(*simulation, seen);
  }
  seen.joined = simulation->particles().size() - simulation->particles_at_start();
  seen.state = state_of(*simulation);
  if (simulation->band_columns() != nullptr) {
    seen.state.erase("load_change");  // used within a step of the band on particles only
  }
  seen.state["bed"] = simulation->bed()->state();
  seen.row = history_row(*simulation);
  set_thread_count(threads_before);
  return seen;
}

template <int Dim>
void expect_valid_runs(const Sets& sets) {
  const Seen first = run<Dim>(sets, 1, 0, -1);
  EXPECT_GT(first.joined, Dim == 2 ? 10U : 20U);
  EXPECT_LT(first.mass, 1e-13);
  EXPECT_LT(first.momentum, 1e-13);
  EXPECT_LT(first.heat, 1e-13);
  EXPECT_LT(first.work, 2e-4);  // of first order in the step: MechanicalBudgetClosesInFirstOrderOfTheStep
  EXPECT_LT(first.bed, 1e-13);
  EXPECT_EQ(first.smallest, 0.0);
  for (const auto& [threads, interval, stop] : {std::tuple(2, 7, -1), std::tuple(2, 3, steps<Dim> / 2)}) {
    const Seen other = run<Dim>(sets, threads, interval, stop);
    const auto when = fmt::format("{} threads, sorted every {} steps, stopped at {}", threads, interval, stop);
    expect_the_same_state(first.state, other.state, when);
    for (std::size_t k = 0; k < first.row.size(); ++k) {
      EXPECT_EQ(std::memcmp(&first.row[k].second, &other.row[k].second, sizeof(double)), 0)
          << first.row[k].first << ", " << when;
    }
  }
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
      Simulation<2> simulation(slide_over_bed<2>({"bed.law=" + law, fmt::format("time.step={}", 0.001 / finer)}));
      Seen seen;
      for (int step = 0; step < steps<2> * finer; ++step) {
        simulation.step(simulation.next_step(1.0));
        record_residuals(simulation, seen);
      }
      left_over[k] = seen.work;
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

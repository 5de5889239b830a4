// Runs that are bitwise identical for any number of threads, any order of particles in memory, and after a restart.
#pragma once

#include <fmt/format.h>

#include <memory>

#include "band/basal_segments.hpp"
#include "base/parallel.hpp"
#include "case_from_text.hpp"
#include "fields.hpp"
#include "io/checkpoint.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::testing_support {

// stop: time step before which the run stops and resumes from its checkpoint; -1: no stop.
struct Execution {
  int threads, sorting_interval, stop;
};

template <int Dim>
void stop_and_resume(std::unique_ptr<sim::Simulation<Dim>>& simulation,
                     std::unique_ptr<sim::Simulation<Dim>> restarted) {
  const auto folder = folder_of_this_test();
  NamedNumbers blocks;
  if (simulation->bed() != nullptr) {
    blocks["bed"] = simulation->bed()->state();
  }
  if (simulation->band_columns() != nullptr) {
    blocks["band_columns"] = band::numbers_of(*simulation->band_columns());
  }
  io::write_checkpoint<Dim>(folder, simulation->particles(), simulation->particles_at_start(), simulation->scalars(),
                            blocks);
  simulation = std::move(restarted);
  std::vector<double> scalars;
  blocks = io::read_checkpoint<Dim>(io::newest_checkpoint(folder), simulation->particles(), scalars);
  simulation->restore(scalars);
  if (simulation->bed() != nullptr) {
    simulation->restore_bed(blocks.at("bed"));
  }
  if (simulation->band_columns() != nullptr) {
    simulation->restore_band_columns(blocks.at("band_columns"));
  }
}

// State after some time steps, with the last row of the history. visit(simulation, k): called before step k, and with
// k = steps at the end.
template <int Dim, class Make, class Visit>
std::map<std::string, std::vector<double>> state_after(const Make& make, int steps, const Execution& by,
                                                       const Visit& visit) {
  const int threads_before = thread_count();
  set_thread_count(by.threads);
  std::unique_ptr<sim::Simulation<Dim>> simulation = make();
  simulation->set_sorting_interval(by.sorting_interval);
  for (int k = 0; k < steps; ++k) {
    visit(*simulation, k);
    if (k == by.stop) {
      stop_and_resume<Dim>(simulation, make());
      simulation->set_sorting_interval(by.sorting_interval);
    }
    simulation->step(simulation->next_step(100.0));
  }
  visit(*simulation, steps);
  (void)simulation->next_step(100.0);  // locates the particles on cells that follow the ground
  auto state = state_of(*simulation);
  if (simulation->band_columns() != nullptr) {
    state.erase("load_change");  // used within a step of the band on particles only
    state["band columns"] = band::numbers_of(*simulation->band_columns());
  }
  if (simulation->bed() != nullptr) {
    state["bed"] = simulation->bed()->state();
  }
  for (const auto& [column, value] : sim::history_row(*simulation)) {
    state["history: " + column] = {value};
  }
  set_thread_count(threads_before);
  return state;
}

// Compares other executions of a run with that by one thread without sorting.
template <int Dim, class Make, class Visit>
void expect_reproducible_run(const Make& make, int steps, const std::vector<Execution>& others, const Visit& visit) {
  const auto first = state_after<Dim>(make, steps, {1, 0, -1}, visit);
  for (const Execution& by : others) {
    expect_the_same_state(
        first, state_after<Dim>(make, steps, by, visit),
        fmt::format("{} threads, sorted every {} steps, stopped at {}", by.threads, by.sorting_interval, by.stop));
  }
}

// Budgets of mass, momentum and heat of bodies that move at about 20 m/s, to round-off.
template <int Dim>
void expect_closed_budgets(const sim::Simulation<Dim>& simulation) {
  const sim::HistoryRow row = sim::history_row(simulation);
  const double mass = simulation.budget().initial_mass;
  EXPECT_NEAR(value_of(row, "mass_residual_kg") / mass, 0.0, 1e-13);
  for (const std::string axis : Dim == 2 ? std::vector{"x", "y"} : std::vector{"x", "y", "z"}) {
    EXPECT_NEAR(value_of(row, "momentum_residual_" + axis + "_N_s") / (mass * 20.0), 0.0, 1e-13);
  }
  const double heat = std::abs(value_of(row, "sensible_J")) + value_of(row, "latent_J");
  EXPECT_NEAR(value_of(row, "thermal_residual_J") / heat, 0.0, 1e-13);
}

}  // namespace thawslide::testing_support

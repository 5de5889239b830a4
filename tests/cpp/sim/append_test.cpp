// Particles added during a run while others leave: ids, rows, balances, and bitwise identical results for any number of
// threads and after a restart.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../support/messages.hpp"
#include "../support/reproducible_runs.hpp"
#include "../support/two_bodies.hpp"
#include "io/snapshot.hpp"
#include "sim/records/end_state.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim>
constexpr double length = Dim == 2 ? 30.0 : 12.0;  // of the left body [m]
template <int Dim>
constexpr int steps = Dim == 2 ? 60 : 30;

// Bodies that slide across the edge of their domain.
template <int Dim>
config::Case leaving_bodies(const Sets& sets) {
  const double end = length<Dim> + 5.0;
  const Sets leaving = "grid.leaving=remove; " +
                       (Dim == 2 ? fmt::format("body.right.velocity=[60,0]; grid.max=[{}, 20.0]", end)
                                 : fmt::format("body.right.velocity=[60,0,0]; grid.max=[{}, 10.0, 20.0]", end));
  return two_bodies<Dim>(5e3, length<Dim>, 5.0, 20.0, sets + leaving);
}

// Particles that move with the left body, starting from a position behind or on top of it.
template <int Dim>
std::vector<NewParticle<Dim>> some_particles(const Simulation<Dim>& simulation, bool behind) {
  std::vector<NewParticle<Dim>> some;
  for (int k = 0; k < 12; ++k) {
    NewParticle<Dim> one;
    one.body = 0;
    one.material = behind ? 0 : 1;
    one.position[Dim - 1] = (behind ? 0.25 : 5.25) + 0.5 * (k % 2) - simulation.model().origin[Dim - 1];
    one.position[0] = (behind ? -2.75 : 4.25) + 0.5 * (k / 2) - simulation.model().origin[0];
    if (Dim == 3) {
      one.position[1] = 1.25 - simulation.model().origin[1];
    }
    one.velocity[0] = 20.0;
    one.volume = std::pow(0.5, Dim);
    one.temperature = behind ? -0.5 : 1.5;
    one.porosity = 0.3;
    one.flow_depth = 0.5;
    one.stress[Dim - 1] = -1e4;
    some.push_back(one);
  }
  return some;
}

// Ids are unique, and rows are in their order.
template <int Dim>
void expect_ids_and_rows(const Simulation<Dim>& simulation, std::size_t joined) {
  const auto& particles = simulation.particles();
  const auto left = static_cast<std::size_t>(simulation.removed().left);
  EXPECT_EQ(particles.size(), simulation.particles_at_start() + joined - left);
  EXPECT_GT(left, 0U);
  const io::Snapshot snapshot = io::make_snapshot<Dim>(particles, simulation.model().origin, 0.0, 0);
  std::map<std::int64_t, std::size_t> by_id;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_TRUE(by_id.emplace(particles.id(p), p).second) << "id " << particles.id(p);
  }
  EXPECT_EQ(by_id.rbegin()->first + 1, static_cast<std::int64_t>(simulation.particles_at_start() + joined));
  ASSERT_EQ(snapshot.particles(), particles.size());
  ASSERT_EQ(snapshot.fields[0].name, "id");
  std::size_t row = 0;
  for (const auto& [id, p] : by_id) {
    EXPECT_EQ(snapshot.fields[0].values[row], static_cast<double>(id));
    EXPECT_EQ(snapshot.points[3 * row], particles.position(p, 0) + simulation.model().origin[0]);
    ++row;
  }
}

// Particles are added twice during the run.
template <int Dim>
void expect_sound_runs(const Sets& sets) {
  const config::Case parameters = leaving_bodies<Dim>(sets);
  constexpr int first = steps<Dim> / 5, second = 3 * steps<Dim> / 5;
  const auto visit = [](Simulation<Dim>& simulation, int step) {
    if (step == first || step == second) {
      simulation.append(some_particles(simulation, step == first));
    }
    expect_closed_budgets(simulation);
    const HistoryRow row = history_row(simulation);
    const double phases = value_of(row, "rock_kg") + value_of(row, "ice_kg") + value_of(row, "water_kg");
    EXPECT_NEAR((phases - value_of(row, "mass_kg")) / simulation.budget().initial_mass, 0.0, 1e-13);
    if (step == steps<Dim>) {
      expect_ids_and_rows(simulation, 24);
    }
  };
  expect_reproducible_run<Dim>([&] { return std::make_unique<Simulation<Dim>>(parameters); }, steps<Dim>,
                               {{2, 7, -1}, {1, 3, second - 5}, {2, 1, second}}, visit);
}

TEST(Append, BalancesCloseAndResultsAreReproducibleInThePlane) { expect_sound_runs<2>({}); }
TEST(Append, BalancesCloseAndResultsAreReproducibleInSpace) { expect_sound_runs<3>({}); }
TEST(Append, BalancesCloseAndResultsAreReproducibleWithOtherChoices) {
  expect_sound_runs<2>("mechanics.transfer=apic; time.stepping=adaptive");
  expect_sound_runs<2>("band.region=first_layer; band.thickness={time=[0.0,0.05],value=[0.1,0.2]}");
  expect_sound_runs<2>("mechanics.effective_stress=true; pressure.thickness_update=frozen; time.step=0.001");
  expect_sound_runs<2>("time.stepping=adaptive");
}

// Particles added with the initial state of another particle equal that particle at t = 0.
TEST(Append, NewParticlesEqualThoseAtTheStart) {
  const config::Case parameters = leaving_bodies<2>({"mechanics.initial_stress=none"});
  const Simulation<2> start(parameters);
  Simulation<2> simulation(parameters);
  const auto& before = start.particles();
  NewParticle<2> one;
  for (std::size_t p = 0; p < before.size(); ++p) {
    if (before.id(p) == 0) {  // the lowest one at the rear of the left body
      one.body = before.body(p);
      one.material = before.material(p);
      one.position = before.position.get<Vector<double, 2>>(p);
      one.velocity = before.velocity.get<Vector<double, 2>>(p);
      one.volume = before.volume(p);
      one.temperature = before.temperature(p);
      one.porosity = before.porosity(p);
      one.flow_depth = before.flow_depth(p);
    }
  }
  simulation.append({one});
  auto fields = fields_by_id(simulation.particles());
  EXPECT_EQ(fields.at("id").back(), static_cast<double>(before.size()));
  fields.erase("id");
  fields.erase("in_band");  // determined in the next time step
  for (const auto& [name, numbers] : fields) {
    const std::size_t components = numbers.size() / (before.size() + 1);
    for (std::size_t c = 0; c < components; ++c) {
      EXPECT_EQ(numbers[before.size() * components + c], numbers[c]) << name;
    }
  }
}

// The warning of growth names the first thing that a case lacks.
TEST(EndState, NamesWhatReducesGrowth) {
  const Sets gaps = "material.frozen.gaps_close_first=true; material.melted.gaps_close_first=true";
  const std::pair<Sets, const char*> remedies[] = {
      {"material.frozen.dilation_angle=5", "Set a smaller dilation_angle"},
      {{}, "Set gaps_close_first = true"},
      {gaps, "Set mechanics.transfer = \"apic\""},
      {gaps + "mechanics.transfer=apic", "Use a smaller grid.cell, or a larger viscosity_number"}};
  for (const auto& [sets, remedy] : remedies) {
    Simulation<2> simulation(leaving_bodies<2>(sets));
    auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.volume(p) *= 1.06;
    }
    const std::vector<std::string> warnings = warnings_of(end_state<2>(simulation, false), false);
    ASSERT_EQ(warnings.size(), 1U);
    expect_in(warnings[0], remedy);
  }
}

// Added particles count with their own volume; dilation is the change since they were added.
TEST(Append, CausesNoDilation) {
  Simulation<2> simulation(leaving_bodies<2>({}));
  const std::size_t before = simulation.particles().size();
  simulation.append(some_particles<2>(simulation, false));
  ASSERT_GT(simulation.particles().size(), before);
  EXPECT_EQ(value_of(history_row(simulation), "dilation_fraction"), 0.0);
  EXPECT_EQ(value_of(history_row(simulation), "dilation_volume_m3"), 0.0);
  double initial = 0.0;
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    initial += particles.initial_volume(p);
    particles.volume(p) *= 1.06;
  }
  EXPECT_NEAR(value_of(history_row(simulation), "dilation_fraction"), 0.06, 1e-12);
  EXPECT_NEAR(value_of(history_row(simulation), "dilation_volume_m3"), 0.06 * initial, 1e-9 * initial);
  const EndState state = end_state<2>(simulation, false);
  EXPECT_NEAR(state.dilation_fraction, 0.06, 1e-12);
  const std::vector<std::string> warnings = warnings_of(state, false);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("dilation has changed the volume of the slide by +6.0 %, ", 0), 0U) << warnings[0];
  expect_in(warnings[0], " m3 (expected: at most 5 %). Thicknesses, areas and volumes are too large by");
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.volume(p) *= 1.049 / 1.06;
  }
  EXPECT_TRUE(warnings_of(end_state<2>(simulation, false), false).empty());
}

}  // namespace
}  // namespace thawslide::sim

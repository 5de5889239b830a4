// Time steps of a device (device/step.hpp) are bitwise identical to those of Simulation, for any order of threads and
// of particles in memory. The stages of Simulation are compiled without contraction here.
#include "device/step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "../support/fields.hpp"
#include "../support/two_bodies.hpp"
#include "device/host_backend.hpp"
#include "sim/simulation.hpp"
#include "sim/solver/step_model.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using device::Host, device::ThreadOrder;

// A pass does not compile if a record is both read and added to, under one name or two.
using mpm::are_disjoint, mpm::RecordList;
static_assert(are_disjoint<RecordList<mpm::Motion, mpm::NodalState>, RecordList<mpm::Velocity, mpm::HeatRates>>);
static_assert(are_disjoint<RecordList<>, RecordList<mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Motion, mpm::Velocity>, RecordList<mpm::HeatRates, mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Velocity>, RecordList<mpm::AffineVelocity>>);
static_assert(!are_disjoint<RecordList<mpm::AffineMotion>, RecordList<mpm::Motion>>);
// Two additions to the same components of a record, and patches of two records in the same memory.
static_assert(mpm::all_apart<RecordList<mpm::NearGround, mpm::NearGroundByLinear, mpm::Clearance>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::Momentum, mpm::AffineMomentum>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::AffineVelocity, mpm::Velocity>, 2>);
static_assert(mpm::one_record<RecordList<mpm::NearGround, mpm::Clearance>>);
static_assert(!mpm::one_record<RecordList<mpm::Velocity, mpm::HeatRates>>);

template <int Dim>
device::StepModel<Dim> step_model_of(const Simulation<Dim>& simulation) {
  return step_model_of(simulation.parameters(), simulation.model(), Clock{});
}

template <int Dim>
using Steps = device::Step<Host, mpm::Ugimp, Dim>;
template <int Dim>
std::unique_ptr<Steps<Dim>> steps_of(Simulation<Dim>& simulation, Host& host) {
  return std::make_unique<Steps<Dim>>(host, step_model_of(simulation), mpm::view_of(simulation.particles()),
                                      simulation.particles().size(),
                                      host_callbacks_of(simulation.model(), simulation.grid().cell()));
}

// Fields that a step without heat and pore pressure does not use.
const std::set<std::string> of_band{"thermal_scaling"};

template <int Dim>
void expect_the_same_particles(const mpm::Particles<Dim>& expected, const mpm::Particles<Dim>& found, bool band,
                               const std::string& when) {
  const auto numbers = fields_by_id(found);
  for (const auto& [name, of_cpu] : fields_by_id(expected)) {
    if (band || of_band.count(name) == 0) {
      EXPECT_EQ(std::memcmp(numbers.at(name).data(), of_cpu.data(), of_cpu.size() * sizeof(double)), 0)
          << name << ", " << when;
    }
  }
}

template <int Dim>
std::vector<double> numbers_of(const terrain::ContactWork<Dim>& contact) {
  std::vector<double> numbers{contact.friction_work, contact.loss,          contact.damping,    contact.node_kinetic,
                              contact.area,          contact.friction_area, contact.shear_force};
  for (const auto& vector : {contact.force, contact.constraint_impulse}) {
    numbers.insert(numbers.end(), vector.begin(), vector.end());
  }
  return numbers;
}

// Sums over steps, as in the budgets: heat by friction, through faces, by advection, by the old apparent capacity, by
// current masses and by rescaling of the band; drained water and heat, vented water.
using StepTotals = std::array<double, 9>;

template <int Dim>
void add(const device::StepSums<Dim>& sums, const physics::Phases& phases, StepTotals& totals) {
  const StepTotals added{sums.heat.friction,      sums.heat.boundary,      sums.heat.advection,
                         sums.heat.capacity,      sums.heat.porosity,      sums.band_rescale,
                         sums.water.drained.mass, sums.water.drained.heat, sums.water.vented(phases)};
  std::transform(totals.begin(), totals.end(), added.begin(), totals.begin(), std::plus<>());
}
template <int Dim>
void expect_the_same_budgets(const Simulation<Dim>& simulation, const StepTotals& found, const std::string& when) {
  const Budget<Dim>& budget = simulation.budget();
  const StepTotals expected{budget.friction_heat, budget.boundary_heat, budget.advection,
                            budget.capacity_heat, budget.porosity_heat, budget.band_rescale,
                            budget.drained_water, budget.drained_heat,  budget.vented_water};
  const std::size_t first = simulation.model().band.heat ? 0 : 6;
  for (std::size_t k = first; k < expected.size(); ++k) {
    EXPECT_EQ(found[k], expected[k]) << "sum " << k << ", " << when;
  }
}

using Fields = std::map<std::string, std::vector<double>>;

// Number of particles that satisfy at_first initially and then `then`.
template <class AtFirst, class Then>
std::ptrdiff_t count(const std::vector<double>& first, const AtFirst& at_first, const std::vector<double>& now,
                     const Then& then) {
  std::ptrdiff_t found = 0;
  for (std::size_t k = 0; k < now.size(); ++k) {
    found += at_first(first[k]) && then(now[k]) ? 1 : 0;
  }
  return found;
}

// Asserts that the compared effects occur in the slide.
template <int Dim>
void expect_water_to_work(const Simulation<Dim>& simulation, const Fields& first) {
  const band::BandModel<Dim>& band = simulation.model().band;
  const Fields now = fields_by_id(simulation.particles());
  const auto melted = [&](double temperature) { return temperature >= band.reference_temperature; };
  const auto frozen = std::not_fn(melted);
  const auto any = [](double /*number*/) { return true; };
  const auto some = [](double number) { return number != 0.0; };
  const auto count_now = [&](const std::string& name, const auto& then) {
    return count(now.at(name), any, now.at(name), then);
  };
  EXPECT_GT(count(first.at("temperature"), frozen, now.at("temperature"), frozen), 0);
  EXPECT_EQ(count(first.at("temperature"), frozen, now.at("temperature"), melted) > 0, band.heat);
  EXPECT_GT(count(first.at("temperature"), melted, now.at("temperature"), melted), 0);
  EXPECT_NE(now.at("flow_depth"), first.at("flow_depth"));
  EXPECT_GT(count_now("pore_pressure", some), 0);
  const bool seeps = band.has_seepage();
  EXPECT_EQ(seeps, count_now("seepage_in_cell", some) > 0);
  EXPECT_EQ(seeps, simulation.budget().drained_water > 0.0);
  EXPECT_EQ(seeps && band.frozen_rows != band::FrozenRows::sealed, simulation.budget().vented_water != 0.0);
  EXPECT_EQ(seeps && band.conservative_advection, simulation.budget().drained_heat > 0.0);
  if (band.needs_normal_load()) {
    EXPECT_NE(now.at("normal_load"), first.at("normal_load"));
    EXPECT_GT(count_now("load_change", some), 0);
    EXPECT_GT(count_now("pore_void", some), 0);
  }
}

// Advances a number of steps; particles are sorted in memory before step `sorted_before`.
template <int Dim>
void expect_the_steps_of_the_cpu(const config::Case& parameters, int steps, int sorted_before, const Host& with) {
  constexpr double dt = 0.002;
  Simulation<Dim> simulation(parameters);
  ASSERT_EQ(simulation.model().motion.shape, mpm::ShapeFunction::ugimp);
  Host host = with;
  const auto mechanics = steps_of(simulation, host);
  const bool heat = simulation.model().band.heat, pressure = simulation.model().band.pressure;
  const Fields first = fields_by_id(simulation.particles());
  StepTotals totals{};
  const std::vector<std::uint64_t> blocks = simulation.grid().blocks();
  for (int k = 0; k < steps; ++k) {
    if (k == sorted_before) {
      mechanics->sort_in_memory();
    }
    const double time = simulation.time();
    simulation.step(dt);
    const auto sums = mechanics->step(time, dt, nullptr);
    const std::string when = fmt::format("step {}", k);
    EXPECT_EQ(numbers_of(sums.contact), numbers_of(simulation.contact())) << when;
    EXPECT_EQ(sums.invalid.id, -1) << when;
    add(sums, simulation.model().band.phases, totals);
    expect_the_same_budgets(simulation, totals, when);
    if (::testing::Test::HasFailure()) {
      return;
    }
  }
  EXPECT_GT(simulation.contact().friction_work, 0.0);
  EXPECT_GT(simulation.budget().plastic, 0.0);
  EXPECT_NE(simulation.grid().blocks(), blocks);
  EXPECT_EQ(mechanics->tables().tiles, simulation.grid().tiles().size());
  mpm::Particles<Dim> found;
  found.resize(simulation.particles().size());
  mechanics->copy_to(mpm::view_of(found));
  expect_the_same_particles(simulation.particles(), found, heat || pressure, "at the end");
  EXPECT_EQ(heat, totals[0] > 0.0);
  EXPECT_EQ(totals[3] != 0.0, heat && !simulation.model().band.secant_capacity);
  EXPECT_EQ(totals[4] != 0.0, heat && simulation.model().band.current_masses);
  EXPECT_EQ(totals[5] != 0.0, parameters.band.thickness.table.value.size() > 1);
  if (pressure) {
    expect_water_to_work(simulation, first);
  }
}

template <int Dim>
config::Case sliding_bodies(const std::vector<std::string>& sets) {
  return two_bodies<Dim>(2e4, 3.0, 3.0, 12.0, sets);
}

template <int Dim>
config::Case without_pressure(const std::string& heat) {
  return sliding_bodies<Dim>({"heat.enabled=" + heat, "pressure.enabled=false"});
}

// The frozen body is close to melting.
template <int Dim>
config::Case with_pressure(std::vector<std::string> sets = {}) {
  sets.push_back("body.left.temperature=-1e-4");
  return sliding_bodies<Dim>(sets);
}

// Pores with the balance of their water.
std::vector<std::string> balanced(const std::string& frozen_rows) {
  return {"pressure.frozen=\"none\"",
          "pressure.frozen_rows=\"" + frozen_rows + "\"",
          "pressure.melt_contraction=true",
          "pressure.skeleton_compressibility=2e-9",
          "pressure.volumetric_term=true",
          "phases.water_expansion_law=\"by_temperature\"",
          "heat.advection_form=\"conservative\""};
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuInThePlane) {
  for (const std::string heat : {"false", "true"}) {
    expect_the_steps_of_the_cpu<2>(without_pressure<2>(heat), 150, -1, Host(ThreadOrder::forward));
    expect_the_steps_of_the_cpu<2>(without_pressure<2>(heat), 150, 60, Host(ThreadOrder::backward, 7));
    expect_the_steps_of_the_cpu<2>(without_pressure<2>(heat), 150, 60, Host(ThreadOrder::shuffled, 32));
  }
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuInSpace) {
  expect_the_steps_of_the_cpu<3>(without_pressure<3>("true"), 100, 50, Host(ThreadOrder::shuffled, 96));
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithVoellmyFriction) {
  const std::vector<std::string> voellmy{"heat.enabled=false", "pressure.enabled=false", "basal.friction=voellmy",
                                         "basal.friction_coefficient=0.2", "basal.turbulent_friction=100"};
  expect_the_steps_of_the_cpu<2>(sliding_bodies<2>(voellmy), 100, 50, Host(ThreadOrder::shuffled, 32));
  expect_the_steps_of_the_cpu<3>(sliding_bodies<3>(voellmy), 60, 30, Host(ThreadOrder::shuffled, 96));
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithPorePressureInThePlane) {
  expect_the_steps_of_the_cpu<2>(with_pressure<2>(), 150, -1, Host(ThreadOrder::forward));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>(), 150, 60, Host(ThreadOrder::shuffled, 32));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({"pressure.seepage=false"}), 150, 60, Host(ThreadOrder::backward, 7));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({"heat.enabled=false"}), 150, 60, Host(ThreadOrder::shuffled, 7));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({"mechanics.effective_stress=true"}), 150, -1,
                                 Host(ThreadOrder::backward, 32));
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithTheBalanceOfWater) {
  expect_the_steps_of_the_cpu<2>(with_pressure<2>(balanced("sealed")), 150, 60, Host(ThreadOrder::forward));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>(balanced("vented")), 150, 60, Host(ThreadOrder::shuffled, 7));
}

// The band entrains material in the first case, and not in the second.
TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithAThickeningBand) {
  const std::string thickness = "band.thickness={time=[0.0, 0.3], value=[0.1, 0.2]}";
  std::vector<std::string> conserving = balanced("vented");
  conserving.insert(conserving.end(), {"band.thickness_change=\"conserving\"", thickness});
  expect_the_steps_of_the_cpu<2>(with_pressure<2>(conserving), 150, 60, Host(ThreadOrder::shuffled, 7));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({"band.region=\"first_layer\"", thickness}), 150, 60,
                                 Host(ThreadOrder::backward, 32));
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithPublishedFormsOfHeat) {
  const std::string capacity = "heat.update=\"apparent_capacity\"", masses = "heat.masses=\"current\"";
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({capacity}), 150, 60, Host(ThreadOrder::shuffled, 7));
  expect_the_steps_of_the_cpu<2>(with_pressure<2>({masses}), 150, 60, Host(ThreadOrder::backward, 32));
  expect_the_steps_of_the_cpu<3>(with_pressure<3>({capacity, masses}), 60, 30, Host(ThreadOrder::shuffled, 96));
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithPorePressureInSpace) {
  expect_the_steps_of_the_cpu<3>(with_pressure<3>(), 100, 50, Host(ThreadOrder::shuffled, 96));
  expect_the_steps_of_the_cpu<3>(with_pressure<3>(balanced("vented")), 100, 50, Host(ThreadOrder::backward, 7));
}

// The emulation shows a missing barrier: a step without the barrier of a number in every group of threads differs.
template <int Dim>
void expect_all_barriers_to_be_needed() {
  Simulation<Dim> simulation(with_pressure<Dim>(balanced("vented")));
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
  }
  const auto step_without = [&](int barrier) {
    Host host(ThreadOrder::shuffled, 7, barrier);
    const auto steps = steps_of(simulation, host);
    steps->step(simulation.time(), 0.002, nullptr);
    mpm::Particles<Dim> found;
    found.resize(simulation.particles().size());
    steps->copy_to(mpm::view_of(found));
    return fields_by_id(found);
  };
  const Fields whole = step_without(device::HostGroup::none);
  for (int barrier = 0; barrier < 6; ++barrier) {
    EXPECT_NE(step_without(barrier), whole) << barrier;
  }
}
TEST(DeviceStep, NeedsAllBarriers) {
  expect_all_barriers_to_be_needed<2>();
  expect_all_barriers_to_be_needed<3>();
}

// Launches of a step in which no particle changes its cell. The CPU waits for four results: whether a particle has
// changed its cell, whether water seeps (for the averages, and for the pressures), and the sums of the step.
TEST(DeviceStep, IsSubmittedInFourGraphs) {
  const config::Case parameters = with_pressure<3>(balanced("vented"));
  Simulation<3> simulation(parameters);
  Host host;
  const auto steps = steps_of(simulation, host);
  // Some of the later steps are so short that all particles remain in their cells.
  std::size_t fewest_waits = 1000, launches = 0;
  double time = 0.0;
  for (int k = 0; k < 20; ++k) {
    const double dt = k < 10 ? 0.002 : 1e-7;
    const std::size_t waits = host.waits(), launched = host.launches();
    steps->step(time, dt, nullptr);
    time += dt;
    if (host.waits() - waits < fewest_waits) {
      fewest_waits = host.waits() - waits;
      launches = host.launches() - launched;
    }
  }
  EXPECT_EQ(fewest_waits, 4u);
  EXPECT_LE(launches, 80u);
}

}  // namespace
}  // namespace thawslide::sim

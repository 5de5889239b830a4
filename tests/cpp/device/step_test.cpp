// Time steps of a device (device/step.hpp) are bitwise identical to those of the CPU, for any order of threads and of
// particles in memory. The stages of Simulation are compiled without contraction here.
#include "device/step.hpp"

#include <algorithm>
#include <functional>

#include "run_on_device.hpp"
#include "sim/solver/device_solver.hpp"

namespace thawslide::sim {
namespace {

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
std::unique_ptr<device::Step<Host, mpm::Ugimp, Dim>> steps_of(Simulation<Dim>& simulation, Host& host) {
  return std::make_unique<device::Step<Host, mpm::Ugimp, Dim>>(
      host, step_model_of(simulation.parameters(), simulation.model(), Clock{}), mpm::view_of(simulation.particles()),
      simulation.particles().size(), host_callbacks_of(simulation.model(), simulation.grid().cell()));
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

// Asserts that the water of the pores moves.
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

// Asserts that the compared effects occur in the slide.
template <int Dim>
void expect_effects(const config::Case& parameters, int steps) {
  Simulation<Dim> simulation(parameters);
  const band::BandModel<Dim>& band = simulation.model().band;
  const Fields first = fields_by_id(simulation.particles());
  const std::vector<std::uint64_t> blocks = simulation.grid().blocks();
  for (int k = 0; k < steps; ++k) {
    simulation.step(0.002);
  }
  const Budget<Dim>& budget = simulation.budget();
  EXPECT_GT(simulation.contact().friction_work, 0.0);
  EXPECT_GT(budget.plastic, 0.0);
  EXPECT_NE(simulation.grid().blocks(), blocks);
  EXPECT_EQ(budget.friction_heat > 0.0, band.heat);
  EXPECT_EQ(budget.capacity_heat != 0.0, band.heat && !band.secant_capacity);
  EXPECT_EQ(budget.band_rescale != 0.0, parameters.band.thickness.table.value.size() > 1);
  if (band.pressure) {
    expect_water_to_work(simulation, first);
  }
}

// By threads in this order, in groups of this size.
template <int Dim>
void expect_the_steps_of_the_cpu(const Sets& sets, const Threads& threads) {
  SCOPED_TRACE(fmt::format("{}D, {}", Dim, fmt::join(sets, "; ")));
  constexpr int steps = Dim == 2 ? 150 : 100;
  EXPECT_EQ(expect_the_same_run<Dim>(sliding_bodies<Dim>(sets), steps, {}, threads), 0);
  expect_effects<Dim>(sliding_bodies<Dim>(sets), steps);
}

const Threads forward{ThreadOrder::forward, 0, 0}, backward{ThreadOrder::backward, 7, 60},
    shuffled{ThreadOrder::shuffled, 32, 60}, in_large_groups{ThreadOrder::shuffled, 96, 50};
const Sets without_pressure = "pressure.enabled=false";
const Sets with_pressure = "body.left.temperature=-1e-4";  // the frozen body is close to melting

// Pores with the balance of their water.
const Sets balanced = with_pressure +
                      "pressure.frozen=none; pressure.melt_contraction=true; pressure.skeleton_compressibility=2e-9; "
                      "pressure.volumetric_term=true; phases.water_expansion_law=by_temperature; "
                      "heat.advection_form=conservative";
const Sets sealed = balanced + "pressure.frozen_rows=sealed", vented = balanced + "pressure.frozen_rows=vented";
const Sets thickening = "band.thickness={time=[0.0, 0.3], value=[0.1, 0.2]}";
const Sets capacity = "heat.update=apparent_capacity";
const Sets voellmy =
    "heat.enabled=false; pressure.enabled=false; basal.friction=voellmy; basal.friction_coefficient=0.2; "
    "basal.turbulent_friction=100";

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuForAnyThreads) {
  for (const Threads& threads : {forward, backward, shuffled}) {
    expect_the_steps_of_the_cpu<2>(without_pressure, threads);
    expect_the_steps_of_the_cpu<2>(without_pressure + "heat.enabled=false", threads);
  }
  expect_the_steps_of_the_cpu<2>(with_pressure, forward);
  expect_the_steps_of_the_cpu<2>(with_pressure, shuffled);
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithEveryOptionInThePlane) {
  expect_the_steps_of_the_cpu<2>(voellmy, shuffled);
  expect_the_steps_of_the_cpu<2>(with_pressure + "pressure.seepage=false", backward);
  expect_the_steps_of_the_cpu<2>(with_pressure + "heat.enabled=false", shuffled);
  expect_the_steps_of_the_cpu<2>(with_pressure + "mechanics.effective_stress=true", backward);
  expect_the_steps_of_the_cpu<2>(sealed, forward);
  expect_the_steps_of_the_cpu<2>(vented, shuffled);
  // The band entrains material in the first case, and not in the second.
  expect_the_steps_of_the_cpu<2>(vented + "band.thickness_change=conserving" + thickening, shuffled);
  expect_the_steps_of_the_cpu<2>(with_pressure + "band.region=first_layer" + thickening, backward);
  expect_the_steps_of_the_cpu<2>(with_pressure + capacity, shuffled);
}

TEST(DeviceStep, IsBitwiseIdenticalToTheCpuWithEveryOptionInSpace) {
  expect_the_steps_of_the_cpu<3>(without_pressure, in_large_groups);
  expect_the_steps_of_the_cpu<3>(voellmy, in_large_groups);
  expect_the_steps_of_the_cpu<3>(with_pressure, in_large_groups);
  expect_the_steps_of_the_cpu<3>(vented, backward);
  expect_the_steps_of_the_cpu<3>(with_pressure + capacity, in_large_groups);
}

// The emulation shows a missing barrier: a step without the barrier of a number in every group of threads differs.
template <int Dim>
void expect_all_barriers_to_be_needed() {
  Simulation<Dim> simulation(sliding_bodies<Dim>(vented));
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
  const config::Case parameters = sliding_bodies<3>(vented);
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

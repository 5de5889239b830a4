// Steps as a device takes them (device/step.hpp) against those of Simulation: the same bits, whatever the order of
// threads and of particles in memory. The stages of Simulation are compiled without contraction here.
#include "device/step.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <set>
#include <vector>

#include "../support/fields.hpp"
#include "../support/two_bodies.hpp"
#include "device/host_backend.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using device::Host, device::ThreadOrder;

template <int Dim>
device::StepModel<Dim, double> step_model_of(const Simulation<Dim, double>& simulation) {
  const Model<Dim, double>& from = simulation.model();
  device::StepModel<Dim, double> model;
  model.cell = simulation.grid().cell();
  for (std::size_t body = 0; body < from.body_names.size(); ++body) {
    model.half_sizes.push_back(from.motion.sizes.half(body));
  }
  model.sides = from.motion.sides;
  model.gravity = from.motion.gravity;
  model.pic_share = from.motion.pic_share;
  model.mass_damping = from.contact.mass_damping;
  model.materials = from.motion.materials;
  model.phases = from.motion.phases;
  model.effective_stress = from.motion.effective_stress;
  model.lubrication = from.motion.lubrication;
  model.faces = from.constraints;
  model.lower = Vector<double, Dim>::Zero();
  model.upper = from.constraints.extent;
  model.base = from.contact.law;
  model.base_holds = from.contact.base_holds;
  model.pore_pressure = from.contact.pore_pressure;
  model.distance_check = from.contact.distance_check;
  if (from.band.heat) {
    EXPECT_TRUE(from.band.secant_capacity && !from.band.current_masses && !from.band.rescaling_mixes);
    const double thickness = simulation.parameters().band.thickness.at(0.0);
    model.heat = device::HeatModel<double>{.physics = from.band,
                                           .content = from.band.heat_content,
                                           .hydraulic_conductivity = from.band.hydraulic_conductivity,
                                           .scaling_in_band = model.cell / thickness,
                                           .scales_all = from.band.region == band::ScaledRegion::all};
  }
  return model;
}

template <int Dim>
device::AskGround<Dim, double> ground_of(const Simulation<Dim, double>& simulation) {
  return [ground = simulation.model().ground, cell = simulation.grid().cell()](
             std::uint64_t block, terrain::GroundAtNode<Dim, double>* nodes) {
    auto first = mpm::Tile<Dim>::index(block);
    for (int& along : first) {
      along *= mpm::Tile<Dim>::edge;
    }
    ground->at_block(first, cell, mpm::Tile<Dim>::edge, nodes);
  };
}

// Fields that a step without heat has no part in.
const std::set<std::string> of_heat{"thermal_scaling"};

template <int Dim>
void expect_the_same_particles(const mpm::Particles<Dim, double>& expected, const mpm::Particles<Dim, double>& found,
                               bool heat, const std::string& when) {
  const auto numbers = fields_by_id(found);
  for (const auto& [name, of_processor] : fields_by_id(expected)) {
    if (heat || of_heat.count(name) == 0) {
      EXPECT_EQ(std::memcmp(numbers.at(name).data(), of_processor.data(), of_processor.size() * sizeof(double)), 0)
          << name << ", " << when;
    }
  }
}

template <int Dim>
void expect_the_same_contact(const terrain::ContactWork<Dim, double>& expected,
                             const terrain::ContactWork<Dim, double>& found, const std::string& when) {
  EXPECT_EQ(found.friction_work, expected.friction_work) << when;
  EXPECT_EQ(found.loss, expected.loss) << when;
  EXPECT_EQ(found.damping, expected.damping) << when;
  EXPECT_EQ(found.node_kinetic, expected.node_kinetic) << when;
  EXPECT_EQ(found.area, expected.area) << when;
  EXPECT_EQ(found.friction_area, expected.friction_area) << when;
  EXPECT_EQ(found.shear_force, expected.shear_force) << when;
  EXPECT_EQ(found.force, expected.force) << when;
  EXPECT_EQ(found.constraint_impulse, expected.constraint_impulse) << when;
}

// So many steps; particles are sorted in memory before number `sorted_before`.
template <int Dim>
void expect_the_steps_of_the_processor(const config::Case& parameters, int steps, int sorted_before, const Host& with) {
  constexpr double dt = 0.002;
  Simulation<Dim, double> simulation(parameters);
  ASSERT_EQ(simulation.model().motion.shape, mpm::ShapeKind::ugimp);
  Host host = with;
  device::Step<Host, mpm::Ugimp<double>, Dim, double> mechanics(host, step_model_of(simulation),
                                                                mpm::view_of(simulation.particles()),
                                                                simulation.particles().size(), ground_of(simulation));
  const bool heat = simulation.model().band.heat;
  double friction_heat = 0, advection = 0, band_rescale = 0;
  const std::vector<std::uint64_t> blocks = simulation.grid().blocks();
  for (int k = 0; k < steps; ++k) {
    if (k == sorted_before) {
      mechanics.sort_in_memory();
    }
    const double time = simulation.time();
    simulation.step(dt);
    const auto sums = mechanics.step(time, dt);
    const std::string when = fmt::format("step {}", k);
    expect_the_same_contact(simulation.contact(), sums.contact, when);
    EXPECT_EQ(sums.bad.id, -1) << when;
    if (heat) {
      EXPECT_EQ(friction_heat += sums.heat.friction, simulation.ledger().friction_heat) << when;
      EXPECT_EQ(advection += sums.heat.advection, simulation.ledger().advection) << when;
      EXPECT_EQ(band_rescale += sums.band_rescale, simulation.ledger().band_rescale) << when;
    }
    if (::testing::Test::HasFailure()) {
      return;
    }
  }
  EXPECT_GT(simulation.contact().friction_work, 0.0);
  EXPECT_GT(simulation.ledger().plastic, 0.0);
  EXPECT_NE(simulation.grid().blocks(), blocks);
  EXPECT_EQ(mechanics.tables().tiles, simulation.grid().tiles().size());
  mpm::Particles<Dim, double> found;
  found.resize(simulation.particles().size());
  mechanics.particles().copy_to(mpm::view_of(found));
  expect_the_same_particles(simulation.particles(), found, heat, "at the end");
  EXPECT_EQ(heat, friction_heat > 0.0);
}

template <int Dim>
config::Case sliding_bodies(const std::string& heat) {
  return two_bodies<Dim>(2e4, 3.0, 3.0, 12.0, "type = \"flat\"\nelevation = 0.0",
                         {"heat.enabled=" + heat, "pressure.enabled=false"});
}

TEST(DeviceStep, HasTheBitsOfTheProcessorInThePlane) {
  for (const std::string heat : {"false", "true"}) {
    expect_the_steps_of_the_processor<2>(sliding_bodies<2>(heat), 150, -1, Host(ThreadOrder::forward));
    expect_the_steps_of_the_processor<2>(sliding_bodies<2>(heat), 150, 60, Host(ThreadOrder::backward, 7));
    expect_the_steps_of_the_processor<2>(sliding_bodies<2>(heat), 150, 60, Host(ThreadOrder::shuffled, 32));
  }
}

TEST(DeviceStep, HasThemInSpace) {
  expect_the_steps_of_the_processor<3>(sliding_bodies<3>("true"), 100, 50, Host(ThreadOrder::shuffled, 96));
}

}  // namespace
}  // namespace thawslide::sim

// Runs on the CPU emulation of the GPU backend compared with runs on the CPU: particles, budgets and maps. The stages
// of Simulation are compiled without contraction here.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <utility>

#include "run_on_device.hpp"
#include "sim/records/run_records.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {
namespace {

TEST(DeviceRun, GivesTheParticlesOfTheCpu) {
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(), 75), 0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>("time.stepping=adaptive"), 45), 0);
  EXPECT_EQ(expect_the_same_run<3>(sliding_bodies<3>(), 35), 0);
}

// Shape functions, transfers, thermal conditions at a face in contact with the body, and heat alone.
template <int Dim>
void expect_the_same_with_every_choice(int steps) {
  const std::string at_face = Dim == 2 ? "grid.min=[0.0,-4.0]" : "grid.min=[0.0,-4.0,-4.0]";
  const std::vector<Sets> choices{
      "mechanics.shape_function=quadratic",
      "mechanics.transfer=apic",
      "mechanics.transfer=apic; mechanics.shape_function=quadratic",
      "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.005",
      "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.005; mechanics.shape_function=quadratic",
      {at_face, "heat.boundary.x_min={temperature=3.0}"},
      {at_face, "heat.boundary.x_min={flux=400.0}"},
      {at_face, "heat.boundary.x_min={temperature=3.0}", "mechanics.enabled=false"},
      "band.region=first_layer",
      "band.region=first_layer; heat.enabled=false",
      "band.region=first_layer; pressure.enabled=false; heat.enabled=false"};
  for (const Sets& sets : choices) {
    SCOPED_TRACE(sets.back());
    EXPECT_EQ(expect_the_same_run<Dim>(sliding_bodies<Dim>(sets), steps), 0);
  }
}
TEST(DeviceRun, SupportsTheOptionsOfACase) {
  expect_the_same_with_every_choice<2>(30);
  expect_the_same_with_every_choice<3>(12);
}

// The frame ends within the left body.
template <int Dim>
void expect_the_same_with_a_frame(int steps) {
  config::Case parameters = sliding_bodies<Dim>();
  Simulation<Dim> without_frame(parameters);
  parameters.frames["driver"] = Dim == 2 ? config::Frame{{-3.0, 2.4}, {7.5, 20.0}, "x", 25.0}
                                         : config::Frame{{-3.0, 2.4, 2.4}, {7.5, 5.0, 20.0}, "y", 25.0};
  EXPECT_EQ(expect_the_same_run<Dim>(parameters, steps), 0);
  Simulation<Dim> with_frame(parameters);
  with_frame.step(0.002);
  without_frame.step(0.002);
  EXPECT_NE(fields_by_id(with_frame.particles()).at("velocity"),
            fields_by_id(without_frame.particles()).at("velocity"));
}
TEST(DeviceRun, MovesTheFramesOfTheCpu) {
  expect_the_same_with_a_frame<2>(45);
  expect_the_same_with_a_frame<3>(12);
}

TEST(DeviceRun, KeepsTheBandColumnsOfTheCpu) {
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(on_columns), 60), 0);
  EXPECT_EQ(expect_the_same_run<3>(sliding_bodies<3>(on_columns), 25), 0);
}

// Entrained material is added to the slide.
TEST(DeviceRun, EntrainsTheBedOfTheCpu) {
  for (const std::string law : {"bed.law=momentum", "bed.law=strength"}) {
    SCOPED_TRACE(law);
    EXPECT_GT(expect_the_same_run<2>(sliding_bodies<2>(loose_bed() + law), 90), 0);
    EXPECT_GT(expect_the_same_run<3>(sliding_bodies<3>(loose_bed() + law), 30), 0);
  }
  EXPECT_GT(expect_the_same_run<2>(sliding_bodies<2>(on_columns + loose_bed() + "bed.law=momentum"), 60), 0);
}

TEST(DeviceRun, SettlesABody) { expect_the_same_settling({}); }

// Particles are copied back when some have left, and only then.
TEST(DeviceRun, RemovesLeavingParticles) {
  const config::Case parameters = sliding_bodies<2>("grid.leaving=remove; grid.max=[11.0,18.0]");
  const int first = steps_until_one_leaves(parameters);
  EXPECT_EQ(expect_the_same_run<2>(parameters, first - 1), 0);
  const int copies = expect_the_same_run<2>(parameters, first + 20);
  EXPECT_GT(copies, 0);
  EXPECT_LE(copies, 21);
}

TEST(DeviceRun, StaysOnKnownGround) {
  for (const std::string sets : {"", "pressure.frozen=none",  // computes the load of particles
                                 "band.region=first_layer; band.thickness={time=[0.0,0.01],value=[0.1,0.2]}"}) {
    EXPECT_EQ(expect_the_same_run<3>(sliding_bodies<3>(on_dem() + sets), 12, bumpy_site(40.0)), 0);
  }
  const config::Case parameters = sliding_bodies<3>(on_dem());
  std::vector<std::string> messages;
  for (const bool on_device : {false, true}) {
    Simulation<3> simulation(parameters, bumpy_site(8.0));
    if (on_device) {
      simulation.use_device("a GPU", emulated_gpu<3>({ThreadOrder::forward}));
    }
    messages.push_back(error_of(simulation));
  }
  EXPECT_NE(messages[0].find("known"), std::string::npos) << messages[0];
  EXPECT_EQ(messages[1], messages[0]);
}

// Above a block with a part of the ground unknown, and well away from it.
TEST(DeviceRun, ChecksEscapedParticlesOnly) {
  const config::Case parameters = sliding_bodies<3>(on_dem());
  for (double known_to = 30.0;; known_to -= 0.5) {
    ASSERT_GT(known_to, 0.0) << "the known ground never ends next to the slide";
    const config::Site site = bumpy_site(known_to, 0.5);
    Simulation<3> simulation(parameters, site);
    bool adjacent = false;
    for (std::size_t t = 0; t < simulation.grid().tiles().size(); ++t) {
      const auto own = static_cast<std::size_t>(simulation.grid().blocks_about_tile(t)[mpm::Tile<3>::stencil / 2]);
      adjacent = adjacent || simulation.ground()->partly_unknown(own);
    }
    if (adjacent) {
      EXPECT_EQ(expect_the_same_run<3>(parameters, 4, site), 0);
      return;
    }
  }
}

void expect_the_same_map(const MapKind& kind, const FlowMaps& found, const FlowMaps& expected) {
  const std::vector<double> of_device = found.raster(kind, MapExtent::whole_grid).values;
  const std::vector<double> of_cpu = expected.raster(kind, MapExtent::whole_grid).values;
  ASSERT_EQ(of_device.size(), of_cpu.size());
  EXPECT_GT(std::count_if(of_cpu.begin(), of_cpu.end(), [](double value) { return !std::isnan(value); }), 5)
      << kind.name;
  EXPECT_EQ(std::memcmp(of_device.data(), of_cpu.data(), of_cpu.size() * sizeof(double)), 0) << kind.name;
}

// Maps with cells as wide as those of the grid, with narrower and wider ones, with band columns, on a plane, and of a
// release in stages.
TEST(DeviceRun, RecordsTheMapsOfTheCpu) {
  const std::vector<Sets> choices{"maps.arrival_thickness=0.1",
                                  "maps.cell=0.6",
                                  "maps.cell=2.7",
                                  on_columns,
                                  "terrain.type=plane; terrain.slope=10; terrain.elevation=-0.2",
                                  "grid.leaving=remove; grid.max=[8.0,10.0,18.0]",
                                  "body.left.release_time=0.03; body.left.velocity=[0,0,0]"};
  for (const Sets& sets : choices) {
    SCOPED_TRACE(sets.front());
    const config::Case parameters = sliding_bodies<3>(sets);
    Simulation<3> on_cpu(parameters), on_device(parameters);
    int copies = 0;
    on_device.use_device("a GPU", counting_copies<3>({ThreadOrder::backward}, copies));
    RunRecords<3> expected(on_cpu, {}), found(on_device, {});
    expected.start(on_cpu);
    found.start(on_device);
    for (int k = 0; k < 40; ++k) {
      on_cpu.step(0.002);
      on_device.step(0.002);
      expected.after_step(on_cpu);
      found.after_step(on_device);
    }
    const auto front = found.front(on_device), expected_front = expected.front(on_cpu);
    ASSERT_TRUE(front && expected_front);
    EXPECT_EQ(front->along, expected_front->along);
    EXPECT_EQ(front->position, expected_front->position);
    EXPECT_EQ(copies > 0, on_cpu.removed().left > 0);
    for (const MapKind& kind : map_kinds()) {
      expect_the_same_map(kind, *found.maps(), *expected.maps());
    }
    EXPECT_EQ(found.path().corners(), expected.path().corners());
  }
}

TEST(DeviceRun, FindsTheFrontOfOneOfTwoBodies) {
  const config::Case parameters = sliding_bodies<3>();
  Simulation<3> on_cpu(parameters), on_device(parameters);
  int copies = 0;
  on_device.use_device("a GPU", counting_copies<3>({}, copies));
  on_cpu.step(0.002);
  on_device.step(0.002);
  MovedMass left{false, on_cpu.bodies_at_start()[0].mass, {}};
  left.bodies.add(0);
  const double front = on_cpu.front(left).along;
  EXPECT_EQ(on_device.front(left).along, front);
  EXPECT_LT(front, on_cpu.front(on_cpu.moved_mass()).along - 3.0) << "the right body is ahead";
}

// The order does not depend on sorting on the device.
TEST(DeviceRun, ReturnsParticlesInTheirOrder) {
  Simulation<2> simulation(sliding_bodies<2>());
  const auto ids = [&] {
    const auto& particles = std::as_const(simulation).particles();
    std::vector<std::int64_t> by_position(particles.size());
    for (std::size_t p = 0; p < by_position.size(); ++p) {
      by_position[p] = particles.id(p);
    }
    return by_position;
  };
  const std::vector<std::int64_t> at_start = ids();
  simulation.use_device("a GPU", emulated_gpu<2>({ThreadOrder::forward}));
  simulation.set_sorting_interval(10);
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
  }
  EXPECT_EQ(ids(), at_start);
}

// Time steps continue with particles that the CPU has modified.
TEST(DeviceRun, ContinuesFromParticlesChangedOnTheCpu) {
  const config::Case parameters = sliding_bodies<2>();
  Simulation<2> on_cpu(parameters), on_device(parameters);
  on_device.use_device("a GPU", emulated_gpu<2>({ThreadOrder::backward}));
  for (Simulation<2>* simulation : {&on_cpu, &on_device}) {
    for (int k = 0; k < 7; ++k) {
      simulation->step(0.002);
    }
    mpm::Particles<2>& particles = simulation->particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.velocity(p, 0) *= 0.5;
    }
    for (int k = 0; k < 6; ++k) {
      simulation->step(0.002);
    }
  }
  expect_the_same_particles(on_device, on_cpu);
}

}  // namespace
}  // namespace thawslide::sim

// Runs on cells that follow rough ground, on the CPU emulation of the GPU backend, compared with runs on the CPU.
#include <cmath>
#include <fstream>

#include "../support/small_terrain.hpp"
#include "run_on_device.hpp"

namespace thawslide::sim {
namespace {

// Bumps a few cells long, below the bodies.
double bumps(double x, double y) { return 0.4 * std::sin(0.7 * x) * std::cos(0.5 * y) - 0.41; }

template <int Dim>
config::Site site_of_bumps() {
  config::Site site;
  if (Dim == 3) {
    site.ground = std::make_shared<const Raster>(raster(-10.0, -10.0, 0.5, 240, 64, bumps));
  }
  return site;
}

template <int Dim>
config::Case on_bumps(const Sets& more) {
  if (Dim == 3) {
    return sliding_bodies<Dim>(on_dem() + more);
  }
  const auto name = folder_of_this_test() / "profile.csv";
  std::string text = "distance_m,terrain_elevation_m\n";
  for (int k = -20; k <= 220; ++k) {
    text += fmt::format("{},{}\n", 0.5 * k, bumps(0.5 * k, 0.0));
  }
  std::ofstream(name) << text;
  return sliding_bodies<Dim>(Sets("terrain.type=profile; terrain.file=" + name.string()) + more);
}

template <int Dim>
int expect_the_same_run_on_bumps(const Sets& more, int steps) {
  return expect_the_same_run<Dim>(on_bumps<Dim>(more), steps, site_of_bumps<Dim>());
}

TEST(DeviceFollowingCells, GiveTheParticlesOfTheCpu) {
  const Sets plane = "terrain.type=plane; terrain.slope=10; terrain.elevation=-0.2";
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(plane), 45), 0);
  EXPECT_EQ(expect_the_same_run<3>(sliding_bodies<3>(plane), 15), 0);
  EXPECT_EQ(expect_the_same_run_on_bumps<2>({}, 75), 0);
  EXPECT_EQ(expect_the_same_run_on_bumps<2>("time.stepping=adaptive", 45), 0);
  EXPECT_EQ(expect_the_same_run_on_bumps<3>({}, 35), 0);
}

template <int Dim>
void expect_the_same_with_every_choice(int steps) {
  const std::vector<Sets> choices{
      "mechanics.transfer=apic",
      "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.005",
      "mechanics.effective_stress=true",
      "pressure.frozen=none",  // computes the load of particles
      "band.region=first_layer",
      "band.thickness={time=[0.0,0.01],value=[0.1,0.2]}",
      "heat.enabled=false; pressure.enabled=false",
      "basal.friction=voellmy; basal.friction_coefficient=0.2; basal.turbulent_friction=100"};
  for (const Sets& sets : choices) {
    SCOPED_TRACE(sets.front());
    EXPECT_EQ(expect_the_same_run_on_bumps<Dim>(sets, steps), 0);
  }
}
TEST(DeviceFollowingCells, SupportTheOptionsOfACase) {
  expect_the_same_with_every_choice<2>(30);
  expect_the_same_with_every_choice<3>(12);
}

TEST(DeviceFollowingCells, KeepTheBandColumnsAndTheBedOfTheCpu) {
  const Sets shorter_steps = "time.step=0.0018";
  EXPECT_EQ(expect_the_same_run_on_bumps<2>(on_columns + shorter_steps, 60), 0);
  EXPECT_EQ(expect_the_same_run_on_bumps<3>(on_columns + shorter_steps, 25), 0);
  EXPECT_GT(expect_the_same_run_on_bumps<2>(loose_bed() + "bed.law=strength" + shorter_steps, 140), 0);
  EXPECT_GT(expect_the_same_run_on_bumps<3>(loose_bed() + "bed.law=momentum" + shorter_steps, 50), 0);
  EXPECT_GT(expect_the_same_run_on_bumps<2>(on_columns + loose_bed() + "bed.law=momentum" + shorter_steps, 110), 0);
}

// Every second particle is stretched; those of the body with larger particles are split after ten steps.
template <int Dim>
void expect_the_same_splits(int steps) {
  const config::Case parameters = on_bumps<Dim>("mechanics.split_stretched=true; mechanics.transfer=apic");
  Simulation<Dim> on_cpu(parameters, site_of_bumps<Dim>()), on_device(parameters, site_of_bumps<Dim>());
  on_device.use_device("a GPU", emulated_gpu<Dim>({}));
  for (Simulation<Dim>* simulation : {&on_cpu, &on_device}) {
    mpm::Particles<Dim>& particles = simulation->particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.surface_stretch(p, 0) = particles.id(p) % 2 == 0 ? 4.0 : 1.0;
    }
    for (int k = 0; k < steps; ++k) {
      simulation->step(0.0018);
    }
  }
  EXPECT_GT(on_cpu.split_count(), 10);
  EXPECT_EQ(on_device.split_count(), on_cpu.split_count());
  EXPECT_EQ(on_device.budget().numerical, on_cpu.budget().numerical);
  expect_the_same_particles(on_device, on_cpu);
}
TEST(DeviceFollowingCells, SplitTheParticlesOfTheCpu) {
  expect_the_same_splits<2>(35);
  expect_the_same_splits<3>(25);
}

TEST(DeviceFollowingCells, LoseTheParticlesOfTheCpu) {
  EXPECT_GT(expect_the_same_run_on_bumps<2>("grid.leaving=remove; grid.max=[8.0,18.0]", 40), 0);
  EXPECT_GT(expect_the_same_run_on_bumps<3>("grid.leaving=remove; grid.max=[8.0,10.0,18.0]", 45), 0);
}

}  // namespace
}  // namespace thawslide::sim

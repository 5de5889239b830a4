// Estimates of memory compared with sums by hand.
#include "sim/memory_need.hpp"

#include <gtest/gtest.h>

#include "../support/messages.hpp"
#include "../support/slide_on_dem.hpp"
#include "band/basal_segment.hpp"
#include "sim/maps/flow_maps.hpp"
#include "sim/maps/map_grid.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// 40 m x 10 m, next to a triangle of 20 m x 5 m.
const Variant two_bodies{
    "block",
    "grid.cell=2; grid.min=[0,-10]; grid.max=[200,50]; material.rock.viscosity_time=0; body.block.max=[40,10]; "
    "body.wedge.material=rock; body.wedge.shape=polygon; body.wedge.vertices=[[60,0],[80,0],[60,5]]; "
    "body.wedge.particles_per_axis=4; basal.friction=lubricated; mechanisms.pressurization=true; heat.enabled=true; "
    "pressure.enabled=true"};

TEST(MemoryNeed, CountsParticlesAndAreaOfBodies) {
  const BodiesAtStart bodies = bodies_at_start<2>(case_from_text(two_bodies), {});
  EXPECT_NEAR(bodies.particles, 400.0 + 200.0, 1e-9) << "400 m2 at 4 in 4 m2, and 50 m2 at 16 in 4 m2";
  EXPECT_NEAR(bodies.area, 40.0 + 20.0, 1e-12);
}

TEST(MemoryNeed, SumsItsParts) {
  const config::Case plain = case_from_text(two_bodies);
  const MemoryNeed need = memory_need<2>(plain, {}, bodies_at_start<2>(plain, {}));
  EXPECT_EQ(need.particles, 600.0 * 631.0);
  EXPECT_EQ(need.output, 600.0 * 800.0);
  EXPECT_EQ(need.columns + need.bed + need.maps + need.ground, 0.0);
  EXPECT_EQ(need.total(), 60e6 + 600.0 * 1431.0);

  const auto of_split = [](const char* limit) {
    return memory_need<2>(case_from_text(two_bodies, {"mechanics.split_stretched=true", limit}), {},
                          bodies_at_start<2>(case_from_text(two_bodies), {}));
  };
  EXPECT_EQ(of_split("mechanics.split_limit=8").total(), 60e6 + 6.0 * 600.0 * 1431.0);
  EXPECT_EQ(of_split("mechanics.split_limit=2").total(), 60e6 + 2.0 * 600.0 * 1431.0);

  const config::Case rich =
      case_from_text(two_bodies,
                     "band.model=columns; band.thickness=0.2; bed.law=momentum; bed.depth=1.0; bed.strength=1e3; "
                     "bed.depth_per_slip=0.1; bed.material=rock");
  const MemoryNeed more = memory_need<2>(rich, {}, bodies_at_start<2>(rich, {}));
  EXPECT_EQ(more.bed, 101.0 * 18.0) << "100 cells across, two masses and 16 bits a column of nodes";
  EXPECT_EQ(more.columns, 5.0 * 60.0 / 2.0 * sizeof(band::BasalSegment<2>));
}

// The release is 100 m x 100 m and 20 m thick on cells of 10 m with 2 particles an axis.
TEST(MemoryNeed, CountsGroundMapsAndReleaseInSpace) {
  const config::Case parameters =
      case_on_dem(release_on_dem({1.0, 0.001, 10.0, {0.0, 0.0, 0.0}, {400.0, 400.0, 400.0}}, elastic_rock(0.0), 20.0));
  config::Site site;
  Raster ground{0.0, 0.0, 20.0, 20.0, 21, 21, std::vector<double>(441, 100.0), ""};
  site.ground = std::make_shared<const Raster>(ground);
  config::Release release;
  release.thickness = {100.0, 100.0, 20.0, 20.0, 5, 5, std::vector<double>(25, 20.0), ""};
  site.releases["slide"] = release;
  const BodiesAtStart bodies = bodies_at_start<3>(parameters, site);
  EXPECT_NEAR(bodies.area, 10000.0, 1e-9);
  EXPECT_NEAR(bodies.particles, 200000.0 / 1000.0 * 8.0, 1e-6);
  const MemoryNeed need = memory_need<3>(parameters, site, bodies);
  EXPECT_EQ(need.ground, 100e6 + 441.0 * 16.0);
  const MapGrid maps = map_grid_of(parameters, site);
  ASSERT_EQ(maps.cell_area(), 400.0);
  EXPECT_EQ(need.maps,
            5.0 * 10000.0 / 400.0 * static_cast<double>(FlowMaps::bytes_of_cell()) + 8.0 * maps.columns * maps.rows);
}

TEST(MemoryNeed, OfParticlesAloneGivesTheCellThatFits) {
  MemoryNeed need;
  need.particles = 8e9;  // eight times too much, in 3D: twice the cell
  EXPECT_NEAR(smallest_cell<3>(need, 0.5, 1e9 + bytes_of_program), 1.0, 1e-9);
  EXPECT_NEAR(smallest_cell<2>(need, 0.5, 2e9 + bytes_of_program), 1.0, 1e-9) << "a quarter is left in the plane";
  EXPECT_NEAR(smallest_cell<3>(need, 0.3, 1e9 + bytes_of_program), 0.6, 1e-9);
  EXPECT_NEAR(smallest_cell<3>(need, 0.123, 1e9 + bytes_of_program), 0.25, 1e-9) << "two digits, rounded up";
}

TEST(MemoryNeed, DetectsThatNoCellHelps) {
  MemoryNeed need;
  need.particles = 1e9;
  need.ground = 3e9;
  EXPECT_EQ(smallest_cell<3>(need, 1.0, 3e9), 0.0);
  need.columns = 1e9;  // columns decrease with the square, particles with the cube
  const double cell = smallest_cell<3>(need, 1.0, 4e9 + bytes_of_program);
  EXPECT_LE(1e9 / (cell * cell * cell) + 1e9 / (cell * cell), 1e9);
  EXPECT_GT(1e9 / std::pow(cell - 0.1, 3) + 1e9 / std::pow(cell - 0.1, 2), 1e9);
}

std::string refusal_of(const config::Case& parameters, const AvailableMemory& available) {
  return error_of([&] { require_memory<2>(parameters, {}, available); });
}

TEST(MemoryNeed, IsRefusedWithTheKeyAndACellThatFits) {
  const config::Case parameters = case_from_text(two_bodies, {"grid.cell=0.02"});
  // 2500 cells per square metre: 400 m2 with 4 particles in each, 50 m2 with 16.
  EXPECT_EQ(refusal_of(parameters, {4e9, "are free"}),
            "--set grid.cell=0.02: grid.cell is 0.02 m, which makes 6,000,000 particles: the run needs about 8.6 GB of "
            "memory (particles 3.8 GB, writing them 4.8 GB), and 4 GB are free. Make grid.cell 0.03 m or more, or "
            "particles_per_axis smaller.");
  EXPECT_EQ(refusal_of(parameters, {8.7e9, "are free"}), "no error");
  EXPECT_EQ(refusal_of(case_from_text(two_bodies), {60.9e6, "are free"}), "no error");
}

// The limit is below the size of the program: no cell size helps, and the message names the largest part.
TEST(MemoryNeed, NamesTheLargestPartIfNoCellHelps) {
  EXPECT_EQ(refusal_of(case_from_text(two_bodies, {"grid.cell=0.02"}), {0.03e9, "are left by the bound of ulimit -v"}),
            "--set grid.cell=0.02: grid.cell is 0.02 m, which makes 6,000,000 particles: the run needs about 8.6 GB of "
            "memory (particles 3.8 GB, writing them 4.8 GB), and 0.03 GB are left by the bound of ulimit -v. Make "
            "grid.cell larger; the rest, 0.06 GB, needs more memory, or a higher limit of it, whatever the cell.");
  const config::Case plain = case_from_text(two_bodies);
  EXPECT_EQ(refusal_of(plain, {0.03e9, "are free"}),
            plain.file +
                ": the run needs about 0.061 GB of memory (the program 0.06 GB), and "
                "0.03 GB are free. The program alone takes 0.06 GB: give it more memory, or a higher limit.");
}

TEST(MemoryNeed, MoreParticlesThanCanBeCountedAreRefused) {
  const config::Case parameters = case_from_text(two_bodies, {"grid.cell=0.002"});
  EXPECT_EQ(refusal_of(parameters, {1e15, "are free"}),
            "--set grid.cell=0.002: grid.cell is 0.002 m, which makes 600,000,000 particles; allowed: 230,000,000. "
            "Make grid.cell "
            "0.0034 m or more, or particles_per_axis smaller.");
}

}  // namespace
}  // namespace thawslide::sim

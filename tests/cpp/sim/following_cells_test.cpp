// Runs on cells that follow the ground: bitwise identical for any number of threads and after a restart, balances with
// an erodible bed, and particles of a body have its exact volume.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>

#include "../support/channel_on_dem.hpp"
#include "../support/following_plane.hpp"
#include "../support/following_slides.hpp"
#include "../support/reproducible_runs.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/records/run_records.hpp"
#include "sim/setup/domain_bottom.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim, class Make, class Visit>
void expect_the_same_bits(const Make& make, int steps, const Visit& visit) {
  expect_reproducible_run<Dim>(make, steps, {{2, 7, -1}, {3, 1, steps / 2}, {4, 3, steps - 1}}, visit);
}
// The terrain falls to -80 m, and the lowest particle starts above -9 m.
TEST(FollowingCells, TheElevationOfTheLowerCornerHasNoEffect) {
  const auto slide = [](const char* lowest) {
    return slide_in_gully(fmt::format("; grid.min=[-200,-200,{}]", lowest));
  };
  const auto low = slide("-200"), high = slide("-9");  // not a whole number of cells below the top
  for (int k = 0; k < 600; ++k) {
    low->step(0.02);
    high->step(0.02);
  }
  ASSERT_EQ(high->particles().size(), low->particles_at_start());
  double lowest = HUGE_VAL;
  std::map<std::int64_t, std::size_t> of_id;
  for (std::size_t p = 0; p < high->particles().size(); ++p) {
    of_id[high->particles().id(p)] = p;
  }
  for (std::size_t p = 0; p < low->particles().size(); ++p) {
    const std::size_t other = of_id.at(low->particles().id(p));
    lowest = std::min(lowest, low->particles().position(p, 2) + low->model().origin[2]);
    for (int a = 0; a < 3; ++a) {
      const double shift = low->model().origin[a] - high->model().origin[a];
      ASSERT_NEAR(low->particles().position(p, a) + shift, high->particles().position(other, a), 1e-3);
    }
  }
  EXPECT_LT(lowest, -9.0) << "the slide passes the elevation of the corner";
  EXPECT_EQ(note_of_bottom(low->parameters(), low->site()), "");
  EXPECT_NE(note_of_bottom(high->parameters(), high->site()).find("It has no effect"), std::string::npos);
}

Sets bed_of(const std::string& material, const std::string& velocity) {
  return "heat.enabled=true; bed.law=strength; bed.depth=2; bed.strength=100; bed.depth_per_slip=0.2; "
         "bed.porosity=0.9; bed.temperature=-0.5; bed.particles_per_axis=4; bed.material=" +
         material + "; " + velocity;
}

template <int Dim, class Make>
void expect_closed_budgets_with_a_bed(const Make& make, int steps) {
  expect_the_same_bits<Dim>(make, steps, [&](const Simulation<Dim>& simulation, int step) {
    expect_closed_budgets(simulation);
    const HistoryRow row = history_row(simulation);
    const double mass = simulation.budget().initial_mass;
    EXPECT_NEAR(value_of(row, "bed_residual_kg") / mass, 0.0, 1e-13);
    EXPECT_NEAR(value_of(row, "bed_residual_J") / value_of(row, "kinetic_J"), 0.0, 1e-13);
    EXPECT_TRUE(step < steps || simulation.particles().size() > simulation.particles_at_start() + 20);
    const auto& particles = simulation.particles();
    const double half = 0.5 * static_cast<double>(simulation.grid().cell()) / 4.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      EXPECT_TRUE(particles.body(p) == 0 || std::abs(particles.contact_offset(p) - half) < 1e-9 * half)
          << "the particle was created at a height of " << particles.contact_offset(p) << " m";
    }
  });
}

TEST(FollowingCells, EntrainABedWithClosedBudgetsInThePlane) {
  const auto make = [] { return slide_on_plane(55.0, bed_of("rock", "body.block.velocity=[11.5,-16.4]")); };
  expect_closed_budgets_with_a_bed<2>(make, 60);
}
TEST(FollowingCells, EntrainABedWithClosedBudgetsInSpace) {
  const auto make = [] { return slide_in_gully(bed_of("debris", "body.slide.velocity=[18,0,-7]")); };
  expect_closed_budgets_with_a_bed<3>(make, 30);
}

// A crest of 45 degrees is 2.5 m lower in the columns. A rock and the ice on it are lowered together: they neither
// overlap nor leave a gap, and keep their volumes.
TEST(FollowingCells, StackedBodiesStandOnTheGroundOfTheCells) {
  constexpr double thickness = 30.0;
  const std::string file = (folder_of_this_test() / "profile.csv").string();
  std::ofstream(file) << "distance_m,terrain_elevation_m\n-300,-300\n0,0\n300,-300\n";
  const Simulation<2> made(
      base_case("block", Sets("time.step=; time.stepping=adaptive; grid.cell=10; "
                              "grid.min=[-200,-250]; grid.max=[200,150]; terrain.type=profile; "
                              "body.block.shape=polygon; body.block.min=; body.block.max=; "
                              "body.block.vertices=[[-50,-50],[0,0],[50,-50],[50,-20],[0,30],[-50,-20]]; "
                              "body.upper.shape=polygon; body.upper.material=rock; body.upper.temperature=-5; "
                              "body.upper.porosity=0.3; "
                              "body.upper.vertices=[[-50,-20],[0,30],[50,-20],[50,10],[0,60],[-50,10]]; "
                              "terrain.file=" +
                              file)));
  const auto& particles = made.particles();
  std::map<double, std::array<double, 4>> columns;  // lowest and highest place of the rock, the same of the ice
  std::array<double, 2> volumes{};
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto body = static_cast<std::size_t>(particles.body(p));
    const auto found =
        columns.try_emplace(particles.position(p, 0), std::array<double, 4>{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL});
    std::array<double, 4>& column = found.first->second;
    column[2 * body] = std::min(column[2 * body], particles.position(p, 1));
    column[2 * body + 1] = std::max(column[2 * body + 1], particles.position(p, 1));
    volumes[body] += static_cast<double>(particles.volume(p));
  }
  ASSERT_GE(columns.size(), 20U);
  const double spacing = thickness / 6;
  for (const auto& [x, column] : columns) {
    const double ground = static_cast<double>(made.model().ground->height(terrain::Surface<2>::Point(x)));
    EXPECT_NEAR(column[0] - ground, 0.5 * spacing, 1e-9);
    EXPECT_NEAR(column[2] - column[1], spacing, 1e-9) << "at x = " << x;
    EXPECT_NEAR(column[3] - column[2], thickness - spacing, 1e-9);
  }
  EXPECT_NEAR(volumes[0], 3000.0, 1e-9 * 3000.0);
  EXPECT_NEAR(volumes[1], 3000.0, 1e-9 * 3000.0);
}

// `ground` is a map of the ground of the cells, which the waves of the gully miss by a metre.
TEST(FollowingCells, MapsAreRelativeToTheGroundOfTheCells) {
  const auto slide = slide_in_gully();
  RunRecords<3> records(*slide, slide->site());
  records.start(*slide);
  const Raster thickness = records.maps()->raster(map_kinds().front(), MapExtent::whole_grid),
               ground = ground_of_cells(slide->parameters(), slide->site(), slide->model());
  ASSERT_EQ(ground.values.size(), thickness.values.size());
  const auto terrain = [&](double x, double y) {
    const Vector<double, 3>& origin = slide->model().origin;
    return slide->model().ground->terrain().height({x - origin[0], y - origin[1]}) + origin[2];
  };
  double volume = 0.0, most = 0.0;
  for (int j = 0; j < ground.rows; ++j) {
    for (int i = 0; i < ground.columns; ++i) {
      const double here = thickness.at(i, j);
      volume += std::isnan(here) ? 0.0 : here * ground.cell_x * ground.cell_y;
      most =
          std::isnan(here) ? most : std::max(most, std::abs(ground.at(i, j) - terrain(ground.x_of(i), ground.y_of(j))));
    }
  }
  const Raster& release = slide->site().releases.begin()->second.thickness;
  const double released =
      std::accumulate(release.values.begin(), release.values.end(), 0.0) * release.cell_x * release.cell_y;
  EXPECT_NEAR(volume, released, 1e-9 * released);
  EXPECT_GT(most, 0.5);
  EXPECT_LT(most, 1.5);
}

}  // namespace
}  // namespace thawslide::sim

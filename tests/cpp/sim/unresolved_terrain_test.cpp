// Warnings name what cells that follow the terrain do not represent, and are absent on terrain that they do.
#include "sim/checks/unresolved_terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "../support/messages.hpp"
#include "../support/slide_on_dem.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// Release of 20 m at x = -75 to -5 m. measured: the DEM before its filter, if any.
Simulation<3> slide_on(const Height& height, double cell, const Sets& sets = {}, const Height& measured = {}) {
  const Place half(200.0, 100.0);
  const auto slide = release_on_dem({20.0, 0.01, cell, {-200.0, -100.0, -300.0}, {200.0, 100.0, 300.0}}, {}, 20.0);
  const Raster thickness = thickness_between(
      -half, half, 5.0, [](double x, double y) { return std::hypot(x + 40.0, y) < 35.0 ? 20.0 : 0.0; });
  const auto raster_of = [&](const Height& heights) {
    return raster_between(-1.25 * half, 1.25 * half, 1.25, heights);
  };
  config::Site site = site_of(raster_of(height), thickness);
  if (measured) {
    site.before_smoothing = std::make_shared<const Raster>(raster_of(measured));
    site.roughness.emplace().width = 8.0;
  }
  return Simulation<3>(case_on_dem(slide, "time.stepping=adaptive" + sets), std::move(site));
}

// Warnings, one per line.
std::string warnings_on(const Height& height, double cell, const Sets& sets = {}, const Height& measured = {}) {
  const Simulation<3> simulation = slide_on(height, cell, sets, measured);
  return fmt::format("{}", fmt::join(warnings_of_unresolved_terrain(simulation, body_figures(simulation)), "\n"));
}

// Triangle of a height and a width [m] across a line at `along` from the origin, on a slope; below it if negative.
Height ridge(double height, double width, double azimuth = 0.0, double along = 60.0) {
  const double cosine = std::cos(azimuth * pi / 180.0), sine = std::sin(azimuth * pi / 180.0);
  return [=](double x, double y) {
    const double across = std::abs(cosine * x + sine * y - along);
    return -0.2 * x + height * std::max(0.0, 1.0 - 2.0 * across / width);
  };
}

constexpr double kept = 2.0 / 3.0;

// Largest cell up to a size that divides the domain [m].
double whole_cell_up_to(double size) {
  for (const double cell : {8.0, 5.0, 4.0, 2.5, 2.0}) {
    if (cell <= size) {
      return cell;
    }
  }
  return 1.25;
}

TEST(UnresolvedTerrain, NamesADykeNarrowerThanTwoColumnsAndTheCellThatKeepsIt) {
  for (const double azimuth : {0.0, 20.0, 45.0, -60.0}) {
    const auto dyke = ridge(9.0, 10.0, azimuth);
    const std::string warnings = warnings_on(dyke, 10.0);
    std::smatch found;
    ASSERT_TRUE(std::regex_match(
        warnings, found,
        std::regex(
            R"(grid.cell: at x = (.*) m, y = (.*) m the terrain has a dyke too narrow for cells of 10 m: )"
            R"(it is (.*) m high, and (.*) m in the columns of nodes. Use cells of at most (.*) m to keep it.)")))
        << warnings;
    const double x = std::stod(found[1]), y = std::stod(found[2]);
    EXPECT_NEAR(std::cos(azimuth * pi / 180.0) * x + std::sin(azimuth * pi / 180.0) * y, 60.0, 1.0);
    EXPECT_NEAR(std::stod(found[3]), 8.0, 1.0);  // above its uphill side
    EXPECT_LT(std::stod(found[4]), kept * std::stod(found[3]));
    EXPECT_LT(std::stod(found[5]), 7.0);
    EXPECT_GE(std::stod(found[5]), 1.6);
    EXPECT_EQ(warnings_on(dyke, whole_cell_up_to(std::stod(found[5]))), "") << azimuth;
  }
}

TEST(UnresolvedTerrain, NamesAGullyNarrowerThanFourColumns) {
  const std::string warnings = warnings_on(ridge(-12.0, 16.0, 90.0, 0.0), 10.0);
  expect_in(warnings, "the terrain has a gully too narrow for cells of 10 m: it is 12 m deep, and ");
  expect_in(warnings, " m in the columns of nodes. Use cells of at most 4 m to keep it.");
  EXPECT_EQ(warnings_on(ridge(-12.0, 16.0, 90.0, 0.0), 4.0), "");
  EXPECT_EQ(warnings_on(ridge(-12.0, 50.0, 90.0, 0.0), 10.0), "");
}

TEST(UnresolvedTerrain, NamesADykeThatTheFilterOfTheDemRemoves) {
  const std::string warnings = warnings_on(ridge(0.5, 40.0), 10.0, {}, ridge(9.0, 10.0));
  expect_in(warnings, "the terrain has a dyke too narrow for cells of 10 m: it is 8");
  expect_in(warnings, "The filter of the DEM, 8 m, removes it: a smaller terrain.smooth keeps it.");
}

// Height of a slope that ends at a cliff 150 m high.
Height cliff_at(double edge) {
  return [=](double x, double /*y*/) { return x < edge ? -0.2 * x : -0.2 * x - 150.0; };
}

TEST(SteepTerrain, NamesGroundOnWhichStepsAreShort) {
  const std::string warnings = warnings_on(cliff_at(100.0), 10.0, "; grid.steepest=85");
  expect_in(warnings, "note: grid.steepest: the ground of the cells is as steep as 8");
  expect_in(warnings, "adaptive steps become 8");  // 1/cos(83 degrees) over 1/cos(atan 0.2): 8.0; 83.2 degrees: 8.3
  EXPECT_EQ(warnings.find("body.slide"), std::string::npos) << "the cliff is far from the body";
}

TEST(SteepTerrain, NamesBodiesWhoseGroundIsLowered) {
  const std::string warnings = warnings_on(cliff_at(0.0), 10.0);
  expect_in(warnings, "body.slide: the ground of the cells is up to ");
  expect_in(warnings, " m below the terrain under it, and the body starts there.");
  expect_in(warnings, "grid.steepest: the terrain is steeper than 65 degrees.");
}

TEST(UnresolvedTerrain, NamesADykeOfAProfile) {
  const std::string file = (folder_of_this_test() / "profile.csv").string();
  std::ofstream(file) << "distance_m,terrain_elevation_m\n-100,0\n70,0\n72.5,8\n75,0\n400,0\n";
  const Simulation<2> simulation(
      base_case("block", Sets("time.step=; time.stepping=adaptive; grid.cell=5; "
                              "grid.min=[-90,-50]; grid.max=[350,80]; terrain.type=profile; body.block.min=[10,0]; "
                              "body.block.max=[50,20]; terrain.file=" +
                              file)));
  const auto warnings = warnings_of_unresolved_terrain(simulation, body_figures(simulation));
  ASSERT_EQ(warnings.size(), 1U);
  expect_in(warnings[0],
            "grid.cell: at x = 72.5 m the terrain has a dyke too narrow for cells of 5 m: it is 8 m high, ");
}

TEST(UnresolvedTerrain, IsSilentOnTerrainThatCellsRepresentOrTheSlideDoesNotReach) {
  const double cell = 10.0;
  EXPECT_EQ(warnings_on(ridge(0.0, 10.0), cell), "") << "a plane";
  EXPECT_EQ(warnings_on(ridge(4.5, 10.0), cell), "") << "low against the release";
  EXPECT_EQ(warnings_on(ridge(12.0, 10.0, 0.0, -185.0), cell), "") << "above the release";
  for (const double azimuth : {0.0, 30.0, 45.0, 90.0}) {
    for (const double along : {0.0, 5.0}) {
      EXPECT_EQ(warnings_on(ridge(200.0, 400.0, azimuth, along), cell), "") << "a sharp crest";
      EXPECT_EQ(warnings_on(ridge(-200.0, 400.0, azimuth, along), cell), "") << "a V valley";
    }
  }
  const auto waves = [](double x, double y) { return -0.3 * x + 10.0 * std::sin(0.06 * x) * std::sin(0.06 * y); };
  EXPECT_EQ(warnings_on(waves, cell), "");
}

TEST(UnresolvedTerrain, ReportsColumnsThatWereLowered) {
  const auto cliff = [](double x, double) { return -0.3 * x + std::clamp(6.0 * (20.0 - x), 0.0, 60.0); };
  const std::string warnings = warnings_on(cliff, 5.0);
  expect_in(warnings, "grid.steepest: the terrain is steeper than 65 degrees. Columns of nodes lowered: ");
  expect_in(warnings, "m at x = 10 m, y = ");
}

}  // namespace
}  // namespace thawslide::sim

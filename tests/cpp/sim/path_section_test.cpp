// The rigid block of a 3D case: its section along a path.
#include "sim/block/path_section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "../support/small_terrain.hpp"
#include "physics/basal/laws.hpp"
#include "sim/block/block.hpp"
#include "sim/block/section.hpp"

namespace thawslide::sim {
namespace {

using testing_support::paper_case;
using testing_support::raster;
using testing_support::value_of;
using testing_support::Variant;

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double slope = 30.0, top = 1000.0, thickness = 30.0, bend_at = 450.0, turn = 60.0;

// A body of 30 m (vertical) from x = 100 to 300 m; its base melts while it slides.
const Variant on_plane{
    "profile",
    "time.end=16; time.step=0.002; time.history_interval=1; grid.cell=10; grid.min=[0,0]; grid.max=[2000,1100]; "
    "material.rock.youngs_modulus=1e9; material.rock.viscosity_time=0.02; material.rock.hydraulic_conductivity=2e-8; "
    "body.slide.temperature=-1; mechanics.slope_shear=false; basal.friction=lubricated; basal.friction_angle=25; "
    "band.thickness=0.05; mechanisms.pressurization=true; heat.enabled=true; pressure.enabled=true"};

// The same as a 2D case, on a profile with one slope along x up to a bend, and another beyond it.
config::Case flat_case(double slope_beyond) {
  const double fall = std::tan(slope * degree), beyond = std::tan(slope_beyond * degree);
  const auto ground = [&](double x) { return top - fall * std::min(x, bend_at) - beyond * std::max(0.0, x - bend_at); };
  std::ofstream file(testing_support::folder_of_this_test() / "profile.csv");
  file << "distance_m,terrain_elevation_m,surface_elevation_m\n";
  file.precision(17);
  for (const auto& [x, t] : std::vector<std::array<double, 2>>{{0.0, 0.0},
                                                               {100.0 - 1e-5, 0.0},
                                                               {100.0, thickness},
                                                               {300.0, thickness},
                                                               {300.0 + 1e-5, 0.0},
                                                               {bend_at, 0.0},
                                                               {2000.0, 0.0}}) {
    file << x << "," << ground(x) << "," << ground(x) + t << "\n";
  }
  file.close();
  return paper_case(on_plane);
}

struct InSpace {
  config::Case parameters;
  config::Site site;
};

// The 3D case: a plane that falls towards an azimuth [degrees from +x], the release 80 m wide about the line of
// steepest descent, and a path that begins at the origin and turns at the bend.
InSpace case_on_dem(const config::Case& flat, double azimuth, double turned, double cell = 5.0) {
  const double down_x = std::cos(azimuth * degree), down_y = std::sin(azimuth * degree);
  const double fall = std::tan(slope * degree);
  const int points = static_cast<int>(std::lround(3405.0 / cell));
  InSpace made{flat, {}};
  made.parameters.general.dimension = 3;
  made.parameters.terrain.kind = config::TerrainKind::dem;
  made.parameters.terrain.file.clear();
  config::Body& body = made.parameters.bodies.at("slide");
  body.shape = config::BodyShape::release;
  Raster ground = raster(-1700.0 + 0.5 * cell, -1700.0 + 0.5 * cell, cell, points, points,
                         [&](double x, double y) { return top - fall * (x * down_x + y * down_y); });
  config::Release release;
  release.thickness = ground.filled(0.0);
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      const double x = ground.x_of(column), y = ground.y_of(row);
      const double along = x * down_x + y * down_y, across = y * down_x - x * down_y;
      if (along > 100.0 && along < 300.0 && std::abs(across) < 40.0) {
        release.thickness.values[ground.index(column, row)] = thickness;
        release.area += cell * cell;
      }
    }
  }
  made.site.releases["slide"] = release;
  made.site.ground = std::make_shared<const Raster>(std::move(ground));
  const double on_x = std::cos((azimuth + turned) * degree), on_y = std::sin((azimuth + turned) * degree);
  made.site.path = {{0.0, 0.0},
                    {bend_at * down_x, bend_at * down_y},
                    {bend_at * down_x + 1100.0 * on_x, bend_at * down_y + 1100.0 * on_y}};
  return made;
}

void expect_same_motion(const std::vector<HistoryRow>& rows, const std::vector<HistoryRow>& expected,
                        double tolerance) {
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), expected[k].size());
    for (std::size_t column = 0; column < rows[k].size(); ++column) {
      if (rows[k][column].first == "drop_height_m") {
        continue;  // a release has a higher top than its particles: PathSection.HeightBeginsAtTheTopOfTheRelease
      }
      const double value = expected[k][column].second;
      EXPECT_NEAR(rows[k][column].second, value, tolerance * std::abs(value) + 1e-9)
          << rows[k][column].first << " at " << rows[k][0].second << " s";
    }
  }
}

std::vector<HistoryRow> run_along_path(const InSpace& made) {
  const PathSection section = section_along_path(made.parameters, made.site);
  return run_block(section.parameters, section.site, Table(1.0), section.start);
}

TEST(PathSection, PlanarTerrainModelGivesTheMotionOfThePlane) {
  const config::Case flat = flat_case(slope);
  const auto expected = run_block(flat);
  ASSERT_GT(value_of(expected.back(), "displacement_m"), 100.0);
  ASSERT_GT(value_of(expected.back(), "band_saturation"), 0.3) << "the base must have begun to melt";
  for (const double azimuth : {0.0, 90.0, 180.0}) {
    SCOPED_TRACE(fmt::format("azimuth {}", azimuth));
    expect_same_motion(run_along_path(case_on_dem(flat, azimuth, 0.0)), expected, 1e-6);
  }
}

// The outline of the release, which is no longer aligned with the points, is resolved to half a cell of the DEM.
TEST(PathSection, ObliquePointsGiveTheMotionOfThePlane) {
  const config::Case flat = flat_case(slope);
  const auto rows = run_along_path(case_on_dem(flat, 37.0, 0.0, 2.5)), expected = run_block(flat);
  for (const char* column : {"velocity_m_s", "displacement_m", "front_position_m", "normal_pressure_Pa"}) {
    EXPECT_NEAR(value_of(rows.back(), column) / value_of(expected.back(), column), 1.0, 0.02) << column;
  }
}

// On the points of the DEM next to the upper end of the release, whose corners lie half a cell higher.
TEST(PathSection, HeightBeginsAtTheTopOfTheRelease) {
  const double fall = std::tan(slope * degree), first = 102.5;
  for (const double azimuth : {0.0, 90.0, 180.0}) {
    SCOPED_TRACE(fmt::format("azimuth {}", azimuth));
    for (const HistoryRow& row : run_along_path(case_on_dem(flat_case(slope), azimuth, 0.0))) {
      const double front = value_of(row, "front_position_m");
      EXPECT_NEAR(value_of(row, "travel_distance_m"), front - 100.0, 1e-6);
      EXPECT_NEAR(value_of(row, "drop_height_m"), thickness + fall * (front - first), 1e-6);
    }
  }
}

// If the path turns away from the line of fall, its slope is that of the plane along the path.
TEST(PathSection, BentPathGivesTheMotionOnTheBentProfile) {
  const double slope_beyond = std::atan(std::tan(slope * degree) * std::cos(turn * degree)) / degree;
  const config::Case flat = flat_case(slope_beyond);
  const auto expected = run_block(flat);
  ASSERT_GT(value_of(expected.back(), "front_position_m"), bend_at + 100.0);
  expect_same_motion(run_along_path(case_on_dem(flat, 90.0, turn)), expected, 1e-6);
  EXPECT_GT(value_of(run_block(flat_case(slope)).back(), "velocity_m_s"),
            1.02 * value_of(expected.back(), "velocity_m_s"));
}

config::Substrate slippery() {
  config::Substrate ice;
  ice.friction = "coefficient";
  ice.numbers[physics::basal::friction_coefficient] = 0.1;
  return ice;
}

// The path crosses a polygon: the block slides as on the corresponding strip of the profile.
TEST(PathSection, CrossesTheSubstratesOfTheMap) {
  config::Case flat = flat_case(slope);
  const double from = 301.25, to = 411.25;  // between stations, which are 2.5 m apart
  flat.substrates["ice"] = slippery();
  flat.substrates["ice"].x_min = from;
  flat.substrates["ice"].x_max = to;
  const auto expected = run_block(flat);
  flat.substrates.clear();
  const double without = value_of(run_block(flat).back(), "displacement_m");
  EXPECT_GT(std::abs(value_of(expected.back(), "displacement_m") - without), 5.0) << "the substrates have no effect";
  InSpace made = case_on_dem(flat, 90.0, 0.0);
  made.parameters.substrates["ice"] = slippery();
  made.parameters.substrates["ice"].outline = "ice.geojson";
  made.site.substrates["ice"].rings = {{{-50.0, from}, {50.0, from}, {50.0, to}, {-50.0, to}, {-50.0, from}}};
  expect_same_motion(run_along_path(made), expected, 1e-6);
  const auto section = section_along_path(made.parameters, made.site);
  ASSERT_EQ(section.site.stretches.size(), 1U);
  EXPECT_NEAR(section.site.stretches[0].from, from, 1.25 + 1e-9);
  EXPECT_NEAR(section.site.stretches[0].to, to, 1.25 + 1e-9);
}

TEST(PathSection, ThicknessIsTheMeanAcrossThePath) {
  InSpace made = case_on_dem(flat_case(slope), 0.0, 0.0);
  Raster& release = made.site.releases.at("slide").thickness;
  for (int row = 0; row < release.rows; ++row) {
    for (int column = 0; column < release.columns; ++column) {
      double& t = release.values[release.index(column, row)];
      t = t > 0.0 ? (release.y_of(row) > 0.0 ? 40.0 : 10.0) : 0.0;
    }
  }
  const config::ProfileTable profile = section_along_path(made.parameters, made.site).site.profile;
  ASSERT_EQ(profile.surface.size(), profile.distance.size());
  for (std::size_t k = 0; k < profile.distance.size(); ++k) {
    const double x = profile.distance[k];
    EXPECT_NEAR(profile.surface[k] - profile.terrain[k], x < 100.0 - 1e-9 || x > 300.0 + 1e-9 ? 0.0 : 25.0, 1e-9) << x;
    EXPECT_NEAR(profile.terrain[k], top - std::tan(slope * degree) * x, 1e-9);
  }
}

TEST(PathSection, FieldsFromMapsBecomeTheirMeanOverTheVolume) {
  InSpace made = case_on_dem(flat_case(slope), 0.0, 0.0);
  config::Body& body = made.parameters.bodies.at("slide");
  body.velocity = {3.0, 7.0, -2.0};
  body.temperature = {};
  body.temperature.over = InitialField::Over::raster;
  config::Release& release = made.site.releases.at("slide");
  Raster temperature = release.thickness.filled(-9.0);
  for (int row = 0; row < temperature.rows; ++row) {
    for (int column = 0; column < temperature.columns; ++column) {
      const std::size_t k = temperature.index(column, row);
      release.thickness.values[k] *= temperature.y_of(row) > 0.0 ? 2.0 : 1.0;
      temperature.values[k] = temperature.y_of(row) > 0.0 ? -3.0 : -9.0;
    }
  }
  release.fields["temperature"] = temperature;
  const PathSection section = section_along_path(made.parameters, made.site);
  const config::Body& flat = section.parameters.bodies.at("slide");
  EXPECT_NEAR(flat.temperature.at(0.0, 0.0), (2.0 * -3.0 + -9.0) / 3.0, 1e-9);
  EXPECT_NEAR(flat.velocity[0], 3.0, 1e-12);
  EXPECT_NEAR(flat.velocity[1], -2.0, 1e-12);
}

// A path given for maps may begin within the release and leave the DEM.
TEST(PathSection, PathNeedsGroundAtTheReleaseOnly) {
  InSpace made = case_on_dem(flat_case(slope), 0.0, 0.0);
  made.site.path = {{250.0, 0.0}, {5000.0, 0.0}};
  const config::ProfileTable profile = section_along_path(made.parameters, made.site).site.profile;
  EXPECT_EQ(profile.distance.front(), -190.0) << "the release begins at -150 m; four cells of 10 m";
  EXPECT_NEAR(profile.distance.back(), 1702.5 - 250.0, 2.5);
}

std::string error_of(const InSpace& made) {
  return testing_support::error_of([&] { static_cast<void>(section_along_path(made.parameters, made.site)); });
}

TEST(PathSection, ReportsMissingRequirements) {
  const config::Case flat = flat_case(slope);
  InSpace made = case_on_dem(flat, 0.0, 0.0);
  made.parameters.file = "case.toml";
  made.parameters.locations = {{"maps.path", "case.toml:60:1"}};
  const InSpace valid = made;
  made.site.path = {{0.0, 400.0}, {1000.0, 400.0}};
  EXPECT_EQ(error_of(made),
            "case.toml:60:1: the path misses the release of body 'slide' by 362 m. Draw it through the release.");
  made = valid;
  made.parameters.general.gravity_tilt = 5.0;
  EXPECT_EQ(error_of(made),
            "case.toml: case.gravity_tilt is 5 degrees towards +x, which a section along a path does not know. Set it "
            "to 0, or use `thawslide run`.");
  made = valid;
  made.parameters.bodies.at("slide").shape = config::BodyShape::box;
  EXPECT_EQ(error_of(made),
            "case.toml: on a DEM the block model slides a body of the shape \"release\". Give body.slide polygons or a "
            "raster, or use `thawslide run`.");
  made = valid;
  made.parameters.bodies["other"] = made.parameters.bodies.at("slide");
  EXPECT_EQ(error_of(made), "case.toml: the block model slides one body, and the case has 2. Use `thawslide run`.");
}

// Down a plane the path is straight, ending half a width before the edge of the DEM.
TEST(SteepestDescent, OfAPlaneIsItsLineOfFall) {
  constexpr double width = 20.0;
  for (const double azimuth : {0.0, 37.0, 90.0, 203.0}) {
    const double down_x = std::cos(azimuth * degree), down_y = std::sin(azimuth * degree);
    const Raster plane =
        raster(-400.0, -400.0, 5.0, 161, 161, [&](double x, double y) { return -0.4 * (x * down_x + y * down_y); });
    const Descent descent = steepest_descent(plane, {3.0, 7.0}, width);
    EXPECT_FALSE(descent.pit);
    for (const Point2& corner : descent.line.corners()) {
      EXPECT_NEAR((corner[0] - 3.0) * down_y - (corner[1] - 7.0) * down_x, 0.0, 1e-9) << azimuth;
    }
    const Point2 end = descent.line.corners().back();
    const double left = 400.0 - std::max(std::abs(end[0]), std::abs(end[1]));
    EXPECT_NEAR(left, 0.5 * width, 0.1 * width);
  }
}

// The ground rises in all directions around the lowest point of a bowl.
TEST(SteepestDescent, OfABowlEndsAtItsLowestPoint) {
  constexpr double width = 20.0;
  const Raster bowl = raster(-400.0, -400.0, 5.0, 161, 161, [](double x, double y) { return 1e-3 * (x * x + y * y); });
  const Descent descent = steepest_descent(bowl, {180.0, 240.0}, width);
  ASSERT_TRUE(descent.pit);
  EXPECT_EQ(*descent.pit, descent.line.corners().back());
  EXPECT_LT(std::hypot((*descent.pit)[0], (*descent.pit)[1]), 0.1 * width);
  EXPECT_NEAR(descent.line.length(), 300.0, 0.1 * width);
  for (const Point2& corner : descent.line.corners()) {
    EXPECT_NEAR(0.8 * corner[0] - 0.6 * corner[1], 0.0, 0.1 * width);
  }
  EXPECT_TRUE(steepest_descent(bowl, {0.0, 0.0}, width).line.empty());
}

TEST(PathSection, WithoutAPathFollowsTheSteepestDescent) {
  const config::Case flat = flat_case(slope);
  InSpace made = case_on_dem(flat, 90.0, 0.0);
  made.site.path.clear();
  const PathSection section = section_along_path(made.parameters, made.site);
  EXPECT_FALSE(section.path_given);
  EXPECT_FALSE(section.pit);
  const auto rows = run_block(section.parameters, section.site), expected = run_block(flat);
  ASSERT_EQ(rows.size(), expected.size());
  for (const char* column : {"velocity_m_s", "displacement_m", "normal_pressure_Pa", "band_saturation"}) {
    EXPECT_NEAR(value_of(rows.back(), column) / value_of(expected.back(), column), 1.0, 1e-6) << column;
  }
  // The path begins at the centre of the release, 200 m down the plane.
  EXPECT_NEAR(value_of(rows.back(), "front_position_m") - value_of(expected.back(), "front_position_m"), -200.0, 1e-3);
}

TEST(PathSection, WithoutADescendingPathReportsTheNeededKey) {
  InSpace made = case_on_dem(flat_case(slope), 0.0, 0.0);
  made.parameters.file = "case.toml";
  made.site.path.clear();
  Raster ground = *made.site.ground;
  const auto reshape = [&](const std::function<double(double, double)>& height) {
    for (int row = 0; row < ground.rows; ++row) {
      for (int column = 0; column < ground.columns; ++column) {
        ground.values[ground.index(column, row)] = height(ground.x_of(column), ground.y_of(row));
      }
    }
    made.site.ground = std::make_shared<const Raster>(ground);
  };
  const auto bowl_about = [](double middle) {
    return [middle](double x, double y) { return 1e-3 * ((x - middle) * (x - middle) + y * y); };
  };
  reshape([](double, double) { return 7.0; });
  EXPECT_EQ(
      error_of(made),
      "case.toml: no downhill path starts at the centre of the release, x = 200, y = 0: over 10 m the terrain is level "
      "or a pit there. Set maps.path to a file with a line from the release along the expected flow path.");
  reshape(bowl_about(260.0));
  testing_support::expect_in(
      error_of(made), "case.toml: the line of steepest descent from the centre of the release ends in a pit at x = ");
  reshape(bowl_about(900.0));
  const PathSection section = section_along_path(made.parameters, made.site);
  ASSERT_TRUE(section.pit);
  // The floor between the lowest points of the DEM, at 897.5 and 902.5 m, is level.
  EXPECT_NEAR(section.pit->along, 700.0, 2.5 + 1e-9);
  EXPECT_NEAR(section.pit->point[0], 900.0, 2.5 + 1e-9);
}

}  // namespace
}  // namespace thawslide::sim

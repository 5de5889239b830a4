// Rasters finer than the ground are averaged over its cells: volumes are conserved for any points and reference
// systems.
#include <random>

#include "gis/polygons.hpp"
#include "gis/sampling.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

// Random thickness at points with any spacing, in 30 m x 24 m, on points of any offset.
TEST(AveragingTest, VolumesAreExactForAnySpacingAndOffsetOfPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> thickness(0.0, 20.0), place(0.0, 10.0);
  for (const auto& [cell_x, cell_y] : {std::pair(1.0, 1.0), {0.3, 0.7}, {2.3, 0.9}, {2.9, 2.9}}) {
    for (const double shift : {0.0, 0.37, 1.5, 2.9}) {
      Raster raster =
          raster_of([&](double, double) { return thickness(random); }, 400000.0 + place(random),
                    300000.0 + place(random), cell_x, static_cast<int>(30.0 / cell_x), static_cast<int>(24.0 / cell_y));
      raster.cell_y = cell_y;
      const Raster layout =
          raster_of([](double, double) { return 0.0; }, raster.x - 15.0 + shift, raster.y - 15.0 - shift, 3.0, 23, 23);
      ASSERT_TRUE(is_finer(raster, layout));
      EXPECT_NEAR(volume_of(averaged(raster, layout, Missing::zero)), volume_of(raster), 1e-9 * volume_of(raster))
          << cell_x << " " << cell_y << " " << shift;
    }
  }
}

TEST(AveragingTest, PointsWithoutDataAreIgnoredOrZero) {
  Raster raster = raster_of([](double, double) { return 8.0; }, 0.0, 0.0, 1.0, 4, 4);
  raster.values[raster.index(0, 0)] = raster.values[raster.index(1, 0)] = missing;
  const Raster layout = raster_of([](double, double) { return 0.0; }, 0.5, 0.5, 2.0, 3, 2);
  const auto mean_at = [&](int column, Missing rule) { return averaged(raster, layout, rule).at(column, 0); };
  EXPECT_NEAR(mean_at(0, Missing::zero), 4.0, 1e-12);
  EXPECT_NEAR(mean_at(0, Missing::nothing), 8.0, 1e-12);
  EXPECT_NEAR(mean_at(0, Missing::unknown), 8.0, 1e-12) << "half of the cell";
  raster.values[raster.index(0, 1)] = missing;
  EXPECT_NEAR(mean_at(0, Missing::nothing), 8.0, 1e-12);
  EXPECT_TRUE(std::isnan(mean_at(0, Missing::unknown)));
  EXPECT_EQ(mean_at(2, Missing::zero), 0.0) << "beyond the raster";
  EXPECT_TRUE(std::isnan(mean_at(2, Missing::nothing)));
}

TEST(AveragingTest, FinerMeansByMoreThanOnePercentAlongAnyAxis) {
  Raster raster = raster_of([](double, double) { return 1.0; }, 400000.0, 300000.0, 5.0, 20, 20);
  const Raster layout = raster_of([](double, double) { return 0.0; }, 400000.0, 300000.0, 5.0, 20, 20);
  EXPECT_FALSE(is_finer(raster, layout));
  raster.cell_y = 4.99;
  EXPECT_FALSE(is_finer(raster, layout));
  raster.cell_y = 4.9;
  EXPECT_TRUE(is_finer(raster, layout));
  EXPECT_FALSE(is_finer(layout, raster));
}

// Ribs of 20 m, one metre in five, over 200 m x 200 m; `cell`: cell size of the raster.
Raster ribs(const std::string& crs, double x, double y, double cell) {
  const auto count = static_cast<int>(std::lround(240.0 / cell));
  return raster_of(
      [&](double east, double north) {
        const double across = east - x - 20.0, up = north - y - 20.0;
        const bool inside = across > 0.0 && across < 200.0 && up > 0.0 && up < 200.0;
        return inside && std::fmod(across, 5.0) < 1.0 ? 20.0 : 0.0;
      },
      x + 0.5 * cell, y + 0.5 * cell, cell, count, count, crs);
}

constexpr double volume_of_ribs = 200.0 * 200.0 * 20.0 / 5.0;

// Outlines along cells of the ground or across them, and the western half.
TEST(AveragingTest, ReleasesKeepTheVolumeOfAFinerRaster) {
  for (const double shift : {0.0, 0.4, 2.5}) {
    for (const double cell : {1.0, 0.5}) {
      const Raster raster = ribs("EPSG:31287", west + 300.0 + shift, south + 300.0 + shift, cell);
      ASSERT_NEAR(volume_of(raster), volume_of_ribs, 1e-6);
      config::Case parameters = case_with_raster(raster);
      EXPECT_NEAR(release_volume(parameters), volume_of_ribs, 1e-6);
      const auto within = [&](const std::string& box) {
        parameters.bodies.at("rock").release = geojson("outline.geojson", {{"", box}});
        return release_volume(parameters);
      };
      EXPECT_NEAR(within(box_at(320 + shift, 320 + shift, 520 + shift, 520 + shift)), volume_of_ribs, 1e-4);
      EXPECT_NEAR(within(box_at(250, 250, 420 + shift, 700)), 0.5 * volume_of_ribs, 1e-4);
    }
  }
}

// Lengths in the other system differ by up to 4 in 10,000, areas by twice as much. Positions in the nearly equal system
// differ by less than a metre; lengths are equal.
TEST(AveragingTest, ReleasesKeepTheVolumeOfAFinerRasterOfAnotherSystem) {
  std::vector<double> x{west + 300.0}, y{south + 300.0};
  ASSERT_TRUE(Reprojection(reference_system_named("EPSG:31287"), reference_system_named("EPSG:32633")).apply(x, y));
  config::Case parameters = case_with_raster(ribs("EPSG:32633", x[0], y[0], 1.0));
  EXPECT_NEAR(release_volume(parameters), volume_of_ribs, 5e-3 * volume_of_ribs);
  parameters.bodies.at("rock").release = geojson("outline.geojson", {{"", box_at(250, 250, 600, 600)}});
  EXPECT_NEAR(release_volume(parameters), volume_of_ribs, 5e-3 * volume_of_ribs);
  const Raster nearly_equal = ribs("EPSG:25833", west + 300.0, south + 300.0, 1.0);
  EXPECT_NEAR(release_volume(case_with_raster(nearly_equal, ground("EPSG:32633"))), volume_of_ribs,
              5e-3 * volume_of_ribs);
}

TEST(AveragingTest, SurfacesFinerThanTheGroundKeepTheVolumeAboveIt) {
  Raster surface = ribs("EPSG:31287", west + 300.0, south + 300.0, 1.0);
  for_points(surface, [&](int column, int row) {
    surface.values[surface.index(column, row)] += plane(surface.x_of(column), surface.y_of(row));
  });
  config::Case parameters = plain_case(ground());
  parameters.bodies["rock"] = surface_body(geotiff("before.tif", surface));
  EXPECT_NEAR(release_volume(parameters), volume_of_ribs, 1e-6 * volume_of_ribs);
  parameters.bodies.at("rock").release = geojson("outline.geojson", {{"", box_at(322, 322, 518, 518)}});
  EXPECT_NEAR(release_volume(parameters), volume_of_ribs * 196.0 * 196.0 / 4e4, 0.01 * volume_of_ribs);
}

// A surface known within the release only, at points of any spacing and offset relative to the ground. Between points
// with a larger spacing than the ground, interpolation conserves the volume nearly.
TEST(AveragingTest, SurfacesWithoutDataAroundTheReleaseKeepItsVolume) {
  for (const double cell : {0.5, 1.0, 2.0, 5.0, 9.0}) {
    for (const double shift : {0.0, 0.3, 2.5, 4.0}) {
      const auto inside = static_cast<int>(198.0 / cell);
      for (const int margin : {0, 6}) {
        const double first = 300.0 + shift - margin * cell;
        Raster surface = raster_of([](double, double) { return missing; }, west + first, south + first, cell,
                                   inside + 2 * margin, inside + 2 * margin);
        for (int k = 0; k < inside * inside; ++k) {
          const int column = margin + k % inside, row = margin + k / inside;
          surface.values[surface.index(column, row)] = plane(surface.x_of(column), surface.y_of(row)) + 10.0;
        }
        config::Case parameters = plain_case(ground());
        parameters.bodies["rock"] = surface_body(geotiff("before.tif", surface));
        const double volume = 10.0 * std::pow(inside * cell, 2);
        // A tolerance, as for noise, removes nothing if the surface is known in a part of a cell.
        for (const double tolerance : {0.01, cell < 5.0 ? 4.0 : 0.01}) {
          parameters.bodies["rock"].surface_tolerance = tolerance;
          EXPECT_NEAR(release_volume(parameters), volume, (cell <= 5.0 ? 1e-6 : 0.01) * volume)
              << cell << ", " << shift << ", " << margin << ", " << tolerance;
        }
      }
    }
  }
}

// Two stripes a metre wide, of -4 and -8 C, average to -6 C; a single invalid value is refused.
TEST(AveragingTest, TemperaturesAreMeansAndEachIsChecked) {
  config::Case parameters = case_with_release({{"", box_at(302, 302, 398, 398)}});
  InitialField& temperature = parameters.bodies.at("rock").temperature;
  Raster stripes = raster_of([](double x, double) { return std::fmod(x - west, 2.0) < 1.0 ? -4.0 : -8.0; },
                             west + 250.5, south + 250.5, 1.0, 200, 200);
  temperature = raster_field(geotiff("temperature.tif", stripes));
  const Raster field = release_of(parameters).fields.at("temperature");
  for (int row = 3; row + 3 < field.rows; ++row) {
    for (int column = 3; column + 3 < field.columns; ++column) {
      EXPECT_NEAR(field.at(column, row), -6.0, 1e-9);
    }
  }
  stripes.values[stripes.index(100, 100)] = -5000.0;
  temperature = raster_field(geotiff("other.tif", stripes));
  expect_message(error_of_site(parameters));
}

TEST(AveragingTest, NegativeThicknessIsNotHiddenByAMean) {
  Raster raster = ribs("EPSG:31287", west + 300.0, south + 300.0, 1.0);
  raster.values[raster.index(100, 100)] = -1.0;
  config::Case parameters = case_with_raster(raster);
  parameters.bodies.at("rock").release = geojson("outline.geojson", {{"", box_at(320, 320, 520, 520)}});
  EXPECT_NE(error_of_site(parameters).find("is -1 m; allowed: 0 and more."), std::string::npos);
}

TEST(AveragingTest, BedsAreAveraged) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  parameters.bed.law = config::BedLaw::strength;
  parameters.bed.depth = raster_field(
      geotiff("bed.tif", raster_of([](double x, double) { return std::fmod(x - west, 5.0) < 1.0 ? 5.0 : 0.0; },
                                   west + 50.5, south + 50.5, 1.0, 900, 700)));
  const Raster depth = load_site(parameters).site.bed_depth;
  int inside = 0;
  for_points(depth, [&](int column, int row) {
    const double x = depth.x_of(column) - west, y = depth.y_of(row) - south;
    if (x >= 100.0 && x <= 900.0 && y >= 100.0 && y <= 700.0) {
      ASSERT_NEAR(depth.at(column, row), 1.0, 1e-9);
      ++inside;
    }
  });
  EXPECT_GT(inside, 1000);
}

}  // namespace
}  // namespace thawslide::gis

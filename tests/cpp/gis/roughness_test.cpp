// Noise of DEMs: detected on ground of any shape, not on clean ground; the resulting filter.
#include "gis/roughness.hpp"

#include <algorithm>
#include <random>

#include "base/raster.hpp"
#include "gis/sampling.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

constexpr double spacing = 5.0;

// Along x and y, in multiples of the point spacing.
using Shape = std::function<double(double, double)>;

// Across a thalweg or a crest at `degrees` from the y axis, between points.
double across(double x, double y, double degrees) {
  const double angle = degrees * M_PI / 180.0;
  return (x - 60.3) * std::cos(angle) + (y - 60.0) * std::sin(angle);
}

std::map<std::string, Shape> shapes() {
  std::map<std::string, Shape> all{
      {"level", [](double, double) { return 0.0; }},
      {"plane", [](double x, double y) { return 0.7 * x - 0.2 * y; }},
      {"smooth hills", [](double x, double y) { return 4.0 * std::sin(0.15 * x) * std::cos(0.12 * y); }},
      {"two scarps",
       [](double x, double y) { return (across(x, y, 20.0) > 0.0 ? 12.0 : 0.0) + (y > 90.0 ? 5.0 : 0.0); }},
      {"U of 16 points", [](double x, double y) {
         const double a = std::min(std::abs(across(x, y, 10.0)), 8.0);
         return -std::sqrt(64.0 - a * a);
       }}};
  for (const double degrees : {0.0, 22.5, 45.0, 70.0}) {
    for (const double wall : {0.577, 1.732}) {
      const std::string name = fmt::format("{:g} degrees, walls of {:g}", degrees, wall);
      all["V at " + name] = [=](double x, double y) { return wall * std::abs(across(x, y, degrees)) - 0.3 * y; };
      all["ridge at " + name] = [=](double x, double y) { return -wall * std::abs(across(x, y, degrees)); };
    }
    all[fmt::format("cliff at {:g} degrees", degrees)] = [=](double x, double y) {
      return std::clamp(3.0 * across(x, y, degrees), -20.0, 20.0) + 0.5 * x;
    };
  }
  return all;
}

Raster ground_of(const Shape& shape, double rms, unsigned seed, int columns = 121, int rows = 121) {
  const Raster clean = raster_of([&](double x, double y) { return 1500.0 + spacing * shape(x / spacing, y / spacing); },
                                 0.0, 0.0, spacing, columns, rows);
  return rms > 0.0 ? with_noise(clean, spacing * rms, seed) : clean;
}

double tilted(double x, double y) { return 0.5 * x - 0.1 * y; }

// Noise of the whole raster [m].
double noise_of(const Raster& raster) { return noise_rms(raster, span_of_points(raster)); }

config::Roughness auto_roughness(const Raster& raster, double cell, const std::vector<Rectangle>& bodies = {}) {
  return roughness_of(raster, span_of_points(raster), cell, {.is_auto = true}, bodies);
}

TEST(RoughnessTest, NoiseIsFoundWithoutBias) {
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Raster raster = ground_of([](double, double) { return 0.0; }, 0.2, seed, 241, 241);
    sum += noise_of(raster) / spacing / 0.2;
  }
  EXPECT_NEAR(sum / 10.0, 1.0, 0.03);
}

TEST(RoughnessTest, NoiseIsFoundOnGroundOfAnyShape) {
  for (const auto& [name, shape] : shapes()) {
    for (const double rms : {0.05, 0.1, 0.2, 0.5}) {
      for (const unsigned seed : {1U, 2U, 3U}) {
        const Raster raster = ground_of(shape, rms, seed);
        EXPECT_NEAR(noise_of(raster) / spacing, rms, 0.2 * rms) << name << ", seed " << seed;
      }
    }
  }
}

// A channel in a domain that is barely wider, with points one and a half cells apart.
TEST(RoughnessTest, NoiseIsFoundInNarrowDomains) {
  for (const double degrees : {0.0, 22.5, 45.0}) {
    const Shape channel = [&](double x, double y) { return std::abs(across(x + 48.3, y, degrees)); };
    for (const unsigned seed : {1U, 2U, 3U}) {
      const Raster raster = ground_of(channel, 0.2, seed, 25, 121);
      EXPECT_NEAR(noise_of(raster) / spacing, 0.2, 0.04) << degrees << ", seed " << seed;
    }
  }
}

TEST(RoughnessTest, CleanGroundOfAnyShapeIsNotFiltered) {
  for (const auto& [name, shape] : shapes()) {
    const Raster raster = ground_of(shape, 0.0, 0);
    for (const double cell : {0.5 * spacing, spacing, 2.0 * spacing}) {
      const config::Roughness found = auto_roughness(raster, cell);
      EXPECT_EQ(found.width, 0.0) << name << ", cell " << cell;
      EXPECT_LT(found.apparent_friction, 0.02) << name << ", cell " << cell;
    }
  }
}

// A rough face above a smooth valley: two bands of noise, along and across.
TEST(RoughnessTest, NoiseOfAPartOfTheDomainCounts) {
  for (const bool is_along : {true, false}) {
    Raster raster = ground_of(tilted, 0.2, 7, 321, 321);
    for_points(raster, [&](int column, int row) {
      if ((is_along ? row : column) > 60) {
        raster.values[raster.index(column, row)] = 1500.0 + spacing * (0.5 * column - 0.1 * row);
      }
    });
    EXPECT_NEAR(noise_of(raster) / spacing, 0.2, 0.04) << is_along;
  }
}

// A band of noise narrower than a tile is not detected in the domain; a release on it triggers the warning.
TEST(RoughnessTest, NoiseBelowABodyCounts) {
  Raster raster = ground_of(tilted, 0.2, 7, 321, 161);
  for_points(raster, [&](int column, int row) {
    if (row < 70 || row > 81) {
      raster.values[raster.index(column, row)] = 1500.0 + spacing * (0.5 * column - 0.1 * row);
    }
  });
  const Rectangle body{50.0 * spacing, 71.0 * spacing, 60.0 * spacing, 80.0 * spacing};
  EXPECT_EQ(noise_of(raster), 0.0);
  EXPECT_GT(noise_below_body(raster, body) / spacing, 0.1);
  EXPECT_LT(noise_below_body(raster, body) / spacing, 0.24);
  EXPECT_EQ(auto_roughness(raster, spacing).width, 0.0);
  EXPECT_GT(auto_roughness(raster, spacing, {body}).width, 0.7 * spacing);
}

// Offsets of whole rows or columns, as found in surveys.
TEST(RoughnessTest, StripesAreNoise) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0.0, 0.2 * spacing);
  std::vector<double> offset(121);
  std::generate(offset.begin(), offset.end(), [&] { return normal(random); });
  for (const bool is_along : {true, false}) {
    Raster raster = ground_of(tilted, 0.0, 0);
    for_points(raster, [&](int column, int row) {
      raster.values[raster.index(column, row)] += offset[static_cast<std::size_t>(is_along ? row : column)];
    });
    EXPECT_NEAR(noise_of(raster) / spacing, 0.2, 0.07) << is_along;
  }
}

TEST(RoughnessTest, NoiseCountsWithinTheRectangleAlone) {
  Raster raster = ground_of([](double, double) { return 0.0; }, 0.3, 5);
  const Rectangle quiet{0.0, 0.0, 40.0 * spacing, 120.0 * spacing};
  set_points(raster, 0, 0, 41, raster.rows, 1500.0);
  EXPECT_EQ(noise_rms(raster, quiet), 0.0);
  EXPECT_NEAR(noise_rms(raster, {45.0 * spacing, 0.0, 120.0 * spacing, 120.0 * spacing}), 0.3 * spacing, 0.3);
  EXPECT_EQ(noise_rms(raster, {1e6, 1e6, 1e6 + 100.0, 1e6 + 100.0}), 0.0);
  EXPECT_EQ(noise_rms(raster, {50.0 * spacing, 0.0, 57.0 * spacing, 7.0 * spacing}), 0.0);
  // Holes are not noise and do not hide noise.
  for (std::size_t k = 0; k < raster.values.size(); k += 37) {
    raster.values[k] = missing;
  }
  EXPECT_NEAR(noise_rms(raster, {45.0 * spacing, 0.0, 120.0 * spacing, 120.0 * spacing}), 0.3 * spacing, 0.3);
}

// Ratio of width to rms and point spacing, all in cells.
TEST(RoughnessTest, WidthIsTheMinimumThatLeavesLittleFriction) {
  struct Row {
    double rms, spacing, width;
  };
  for (const Row& row : {Row{0.0, 1.0, 0.0}, Row{0.03, 1.0, 0.0}, Row{0.05, 1.0, 0.5}, Row{0.05, 0.5, 0.35},
                         Row{0.1, 1.0, 0.7}, Row{0.1, 0.5, 0.5}, Row{0.2, 1.0, 1.0}, Row{0.2, 0.5, 0.7},
                         Row{0.5, 1.0, 1.6}, Row{0.5, 0.5, 1.1}, Row{0.2, 2.0, 1.4}, Row{9.0, 1.0, 2.0}}) {
    const double width = fitting_width(row.rms * 4.0, row.spacing * 4.0, 4.0);
    EXPECT_NEAR(width, row.width * 4.0, 1e-12) << row.rms << ", " << row.spacing;
    const bool is_widest = row.rms > 1.0;
    EXPECT_TRUE(is_widest || noise_slope(row.rms * 4.0, row.spacing * 4.0, 4.0, width) <= largest_slope * (1.0 + 1e-9));
  }
}

// Waves in all directions, with one wavelength [points] and an rms slope.
Shape waves(double length, double slope) {
  return [=](double x, double y) {
    constexpr int count = 24;
    double height = 0.0;
    for (int k = 0; k < count; ++k) {
      const double angle = M_PI * k / count, phase = 2.4 * k * k;
      height += std::sin(2.0 * M_PI / length * (x * std::cos(angle) + y * std::sin(angle)) + phase);
    }
    return height * slope * length / (2.0 * M_PI) * std::sqrt(2.0 / count);
  };
}

// (1 - exp(-2 pi^2 2.2^2 / L^2))^3 of the slope, minus the reduction by the filter.
TEST(RoughnessTest, BumpsShorterThanEightPointsCount) {
  for (const double length : {5.0, 6.5, 7.8, 10.0, 16.0, 30.0}) {
    const Raster raster = ground_of(waves(length, 0.2), 0.0, 0, 241, 241);
    const double part = std::pow(1.0 - std::exp(-2.0 * std::pow(M_PI * 2.2 / length, 2)), 3);
    for (const double width : {1.0, 1.5}) {
      const double kept = std::exp(-2.0 * std::pow(M_PI * width / length, 2));
      const Raster found = short_waves(raster, span_of_points(raster), spacing);
      EXPECT_NEAR(bump_slope(found, span_of_points(raster), spacing, width * spacing), 0.2 * part * kept,
                  0.25 * 0.2 * part * kept + 0.001)
          << length << ", " << width;
    }
  }
  EXPECT_DOUBLE_EQ(bump_length(5.0, 5.0), 39.0);
  EXPECT_DOUBLE_EQ(bump_length(5.0, 20.0), 78.0);
}

// Bumps several points long, which white noise does not represent: the filter leaves little of them, and the same on
// all cells that the points resolve.
TEST(RoughnessTest, BumpsOfSeveralPointsAreFilteredEquallyOnAllCells) {
  const Raster raster = ground_of(waves(7.0, 0.25), 0.0, 0, 241, 241);
  const double width = auto_roughness(raster, spacing).width;
  EXPECT_GT(width, spacing);
  EXPECT_LT(width, 2.0 * spacing);
  for (const double cell : {0.5 * spacing, 1.3 * spacing, 2.0 * spacing}) {
    const config::Roughness found = auto_roughness(raster, cell);
    EXPECT_DOUBLE_EQ(found.width, width);
    EXPECT_LE(found.remaining_slope, largest_slope);
    EXPECT_GT(found.bump_slope, 0.1);
  }
  EXPECT_GT(roughness_of(raster, span_of_points(raster), spacing, {.number = 0.5 * spacing}).remaining_slope, 0.1);
}

// Friction found in runs without a filter and with one: docs/theory/roughness.md.
TEST(RoughnessTest, ApparentFrictionAgreesWithRuns) {
  struct Row {
    double rms, spacing, width, friction;
  };
  for (const Row& row :
       {Row{0.1, 1.0, 0.0, 0.157}, Row{0.1, 0.5, 0.0, 0.227}, Row{0.2, 1.0, 0.0, 0.418}, Row{0.2, 0.5, 0.0, 0.627},
        Row{0.1, 1.0, 0.5, 0.067}, Row{0.1, 0.5, 0.5, 0.019}, Row{0.2, 1.0, 0.5, 0.202}, Row{0.2, 0.5, 0.5, 0.073},
        Row{0.5, 1.0, 0.5, 0.75}, Row{0.5, 0.5, 0.5, 0.31}, Row{0.2, 1.0, 1.0, 0.016}, Row{0.5, 1.0, 1.0, 0.083}}) {
    const double found = apparent_friction(noise_slope(row.rms, row.spacing, 1.0, row.width));
    EXPECT_NEAR(found, row.friction, std::max(0.025, 0.2 * row.friction)) << row.rms << ", " << row.spacing;
  }
  EXPECT_EQ(apparent_friction(0.0), 0.0);
  EXPECT_DOUBLE_EQ(apparent_friction(0.03), 0.01);
  EXPECT_DOUBLE_EQ(apparent_friction(0.06), 0.025);
  EXPECT_DOUBLE_EQ(apparent_friction(0.56), 0.76);
  EXPECT_GT(apparent_friction(0.7), 0.76);
}

TEST(RoughnessTest, GroundOfACaseIsFilteredByItsNoise) {
  const Raster rough = with_noise(ground(), 1.0, 11);
  config::Case parameters = plain_case(rough);
  const SiteAndWarnings loaded = load_site(parameters);
  const config::Roughness found = *loaded.site.roughness;
  EXPECT_NEAR(found.noise, 1.0, 0.2);
  EXPECT_EQ(found.spacing, 5.0);
  EXPECT_EQ(found.width, fitting_width(found.noise, 5.0, parameters.grid.cell));
  EXPECT_NEAR(found.width, 5.0, 1.0);
  EXPECT_EQ(found.narrow_valley, 40.0 * found.width);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_EQ(
      loaded.warnings.front(),
      fmt::format("note: dem.tif was smoothed with a standard deviation of {:g} m, as it has noise of {:.2g} m rms and "
                  "bumps with an rms slope of {:.2g} (terrain.smooth = \"auto\")",
                  found.width, found.noise, found.bump_slope));
  EXPECT_EQ(roughness_warning(parameters, loaded.site), "");
  const Raster &ground = *loaded.site.ground, whole = smoothed(rough, found.width);
  const auto column = static_cast<int>(std::lround((ground.x - west) / 5.0));
  const auto row = static_cast<int>(std::lround((ground.y - south) / 5.0));
  for (int k = 0; k < ground.rows; ++k) {
    ASSERT_NEAR(ground.at(k, k), whole.at(column + k, row + k), 1e-9);
  }
  parameters.terrain.smooth = {.number = 20.0};
  EXPECT_EQ(roughness_warning(parameters, load_site(parameters).site), "");
  parameters.terrain.smooth = {};
  const SiteAndWarnings raw = load_site(parameters);
  EXPECT_EQ(raw.site.roughness->noise, found.noise);
  EXPECT_EQ(raw.site.ground->at(20, 20), rough.at(column + 20, row + 20));
  EXPECT_EQ(roughness_warning(parameters, raw.site).substr(0, 16), "terrain.smooth: ");
  // Points interpolated between those of the file are equally rough.
  parameters.terrain.smooth.is_auto = true;
  parameters.terrain.resample = 2.5;
  EXPECT_EQ(load_site(parameters).site.roughness->noise, found.noise);
}

// Domains whose sides are on points, with point spacings that are not binary fractions.
TEST(RoughnessTest, PointsAreKeptIfTheDomainIsAlignedWithThem) {
  for (const double distance : {3.3, 2.2, 2.1, 1.1, 4.7, 0.7, 5.0}) {
    for (const int first : {20, 21, 27}) {
      const Raster rough = with_noise(raster_of(plane, west, south, distance, 101, 91), 0.3 * distance, 3);
      config::Case parameters = plain_case(rough);
      parameters.grid.cell = distance;
      parameters.grid.min = {rough.x_of(first), rough.y_of(first), 1000.0};
      parameters.grid.max = {rough.x_of(80), rough.y_of(70), 2500.0};
      const config::Site site = load_site(parameters).site;
      ASSERT_GT(site.roughness->width, 0.0) << distance;
      ASSERT_EQ(site.ground->columns, site.before_smoothing->columns) << distance;
      ASSERT_EQ(site.ground->rows, site.before_smoothing->rows) << distance;
      EXPECT_NEAR(site.ground->x, site.before_smoothing->x, 1e-6 * distance);
      EXPECT_NEAR(site.ground->y, site.before_smoothing->y, 1e-6 * distance);
    }
  }
}

// Neither a surface before the release nor the ground it is compared with is smoothed.
TEST(RoughnessTest, ThicknessBelowASurfaceIsTheDifferenceOfTheFiles) {
  const Raster rough = with_noise(ground(), 1.0, 12);
  Raster before = rough;
  for (double& height : before.values) {
    height += 8.0;
  }
  // The same if the file of the DEM declares a different system than the case.
  Raster of_other_system = rough;
  of_other_system.crs = ground("EPSG:32633").crs;
  for (const Raster& dem : {rough, of_other_system}) {
    config::Case parameters = plain_case(dem);
    parameters.terrain.crs = "EPSG:31287";
    config::Body body = release_body(geojson("release.geojson", {{"", box_at(400.0, 300.0, 500.0, 400.0)}}), 0.0);
    body.thickness = {config::MapValue::From::surface, 0.0, geotiff("before.tif", before)};
    parameters.bodies["rock"] = body;
    const config::Site site = load_site(parameters).site;
    EXPECT_GT(site.roughness->width, 0.0);
    EXPECT_NEAR(volume_of(site.releases.at("rock").thickness), 8.0 * 100.0 * 100.0, 1e-6);
    // Without polygons: the surface is 8 m above the ground at 20 x 20 points and on it elsewhere.
    Raster partly = rough;
    for (int row = 60; row < 80; ++row) {
      for (int column = 80; column < 100; ++column) {
        partly.values[partly.index(column, row)] += 8.0;
      }
    }
    parameters.bodies["rock"].release.clear();
    parameters.bodies["rock"].thickness.source = geotiff("partly.tif", partly);
    EXPECT_NEAR(volume_of(release_of(parameters).thickness), 8.0 * 100.0 * 100.0, 1e-6);
  }
}

}  // namespace
}  // namespace thawslide::gis

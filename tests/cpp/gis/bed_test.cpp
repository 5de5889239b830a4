// The depth of an erodible bed from a raster: the same as a number, and what is refused.
#include "gis/bed.hpp"

#include <cmath>

#include "config/read_case.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

config::Case slide_over_bed(const std::string& depth) {
  geotiff("dem.tif", raster_of([](double x, double) { return 600.0 - 0.2 * (x - west); }, west, south, 5.0, 61, 21));
  geojson("release.geojson", {{"", box_at(35.0, 35.0, 75.0, 65.0)}});
  const std::string text = fmt::format(
      R"([case]
dimension = 3
[time]
end = 1.0
step = 0.002
[grid]
cell = 5.0
min = [{}, {}, 500.0]
max = [{}, {}, 640.0]
[terrain]
type = "dem"
file = "dem.tif"
[material.debris]
law = "mohr_coulomb"
youngs_modulus = 2e7
poisson_ratio = 0.3
friction_angle = 30.0
cohesion = 0.0
[body.slide]
material = "debris"
shape = "release"
release = "release.geojson"
thickness = 10.0
velocity = [10.0, 0.0, -2.0]
[heat]
enabled = false
[pressure]
enabled = false
[basal]
friction = "constant"
friction_angle = 25.0
[bed]
law = "strength"
strength = 0.0
depth_per_slip = 0.2
material = "debris"
porosity = 0.4
depth = {}
)",
      west + 10.0, south + 10.0, west + 290.0, south + 90.0, depth);
  return config::read_case(text_file("case.toml", text), {});
}

double taken_after(const config::Case& parameters) {
  sim::Simulation<3, double> simulation(parameters, load_site(parameters).site);
  while (simulation.time() < parameters.time.end) {
    simulation.step(simulation.next_step(parameters.time.end));
  }
  for (const auto& [name, value] : sim::history_row(simulation)) {
    if (name == "entrained_mass_kg") {
      return value;
    }
  }
  return std::nan("");
}

std::string depth_file(const std::function<double(double, double)>& depth, int columns = 31) {
  return geotiff("depth.tif", raster_of(depth, west, south, 10.0, columns, 11));
}

TEST(BedOfMaps, RasterOfOneDepthIsTheNumber) {
  const double of_number = taken_after(slide_over_bed("1.5"));
  depth_file([](double, double) { return 1.5; });
  const double of_raster = taken_after(slide_over_bed("{ raster = \"depth.tif\" }"));
  EXPECT_GT(of_number, 1e5);
  EXPECT_NEAR(of_raster / of_number, 1.0, 1e-6);
}

TEST(BedOfMaps, WhatDoesNotCoverTheDomainIsRefused) {
  depth_file([](double, double) { return 1.5; }, 20);
  EXPECT_NE(
      error_of_site(slide_over_bed("{ raster = \"depth.tif\" }"))
          .find("depth.tif: at 400195, 300010, in the domain, the depth of the bed is missing; allowed: from 0 m, "
                "where there is no bed, to grid.cell, 5 m. Fill the raster with 0 over the whole domain, or make "
                "the domain smaller."),
      std::string::npos)
      << error_of_site(slide_over_bed("{ raster = \"depth.tif\" }"));
}

TEST(BedOfMaps, DepthsThatCannotBeAreRefused) {
  depth_file([](double x, double) { return x > west + 100.0 ? 6.0 : 0.0; });
  EXPECT_NE(error_of_site(slide_over_bed("{ raster = \"depth.tif\" }")).find("the depth of the bed is 6 m; allowed"),
            std::string::npos);
  depth_file([](double, double) { return -0.5; });
  EXPECT_NE(error_of_site(slide_over_bed("{ raster = \"depth.tif\" }")).find("the depth of the bed is -0.5 m; allowed"),
            std::string::npos);
}

}  // namespace
}  // namespace thawslide::gis

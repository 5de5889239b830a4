// Depth of an erodible bed from a raster: equal to a number, and refused rasters.
#include "gis/bed.hpp"

#include <cmath>

#include "debris_slide.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::gis {
namespace {

using namespace debris_slide;

config::Case slide_over_bed(const std::string& depth) {
  return debris_case([](double x, double) { return 600.0 - 0.2 * (x - west); }, 1.0, "[10.0, 0.0, -2.0]",
                     "[bed]\nlaw = \"strength\"\nstrength = 0.0\ndepth_per_slip = 0.2\nmaterial = \"debris\"\n"
                     "porosity = 0.4\ndepth = " +
                         depth + "\n");
}

double taken_after(const config::Case& parameters) {
  sim::Simulation<3> simulation(parameters, load_site(parameters).site);
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

TEST(BedOfMaps, UniformRasterIsEqualToTheNumber) {
  const double of_number = taken_after(slide_over_bed("1.5"));
  depth_file([](double, double) { return 1.5; });
  const double of_raster = taken_after(slide_over_bed("{ raster = \"depth.tif\" }"));
  EXPECT_GT(of_number, 1e5);
  EXPECT_NEAR(of_raster / of_number, 1.0, 1e-6);
}

TEST(BedOfMaps, RasterThatDoesNotCoverTheDomainIsRefused) {
  depth_file([](double, double) { return 1.5; }, 20);
  EXPECT_NE(
      error_of_site(slide_over_bed("{ raster = \"depth.tif\" }"))
          .find("depth.tif: at 400195, 300010, in the domain, the depth of the bed is missing; allowed: from 0 m, "
                "where there is no bed, to grid.cell, 5 m. Fill the raster with 0 over the whole domain, or make "
                "the domain smaller."),
      std::string::npos)
      << error_of_site(slide_over_bed("{ raster = \"depth.tif\" }"));
}

TEST(BedOfMaps, InvalidDepthsAreRefused) {
  depth_file([](double x, double) { return x > west + 100.0 ? 6.0 : 0.0; });
  EXPECT_NE(error_of_site(slide_over_bed("{ raster = \"depth.tif\" }")).find("the depth of the bed is 6 m; allowed"),
            std::string::npos);
  depth_file([](double, double) { return -0.5; });
  EXPECT_NE(error_of_site(slide_over_bed("{ raster = \"depth.tif\" }")).find("the depth of the bed is -0.5 m; allowed"),
            std::string::npos);
}

}  // namespace
}  // namespace thawslide::gis

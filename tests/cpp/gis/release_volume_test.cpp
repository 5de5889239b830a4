// Volume and mass of releases of every kind, from their files to the particles and the maps of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/record.hpp"
#include "base/error.hpp"
#include "base/raster.hpp"
#include "gis/site.hpp"
#include "map_files.hpp"
#include "sim/records/run_records.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/simulation.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;
using testing_support::paper_case;

constexpr double west = 400000.0, south = 300000.0;

// Undulating ground that falls by 27 degrees to the east, and the cosine of its slope.
double height(double x, double y) {
  return 1500.0 - 0.5 * (x - west) + 8.0 * std::sin((x - west) / 60.0) * std::cos((y - south) / 70.0);
}
double slope_cosine(double x, double y) {
  const double across = (x - west) / 60.0, up = (y - south) / 70.0;
  const double along_x = -0.5 + 8.0 / 60.0 * std::cos(across) * std::cos(up);
  const double along_y = -8.0 / 70.0 * std::sin(across) * std::sin(up);
  return 1.0 / std::sqrt(1.0 + along_x * along_x + along_y * along_y);
}

// Extent of the raster of a thickness; it does not follow the polygons.
double thickness_on_map(double x, double y) { return 9.0 + 0.02 * (x - west - 300.0) + 0.01 * (y - south - 300.0); }

// A parallelogram with a separate thickness.
struct Polygon {
  std::array<double, 2> corner, first, second;  // from west, south; its sides [m]
  double thickness;

  [[nodiscard]] std::array<double, 2> at(double along_first, double along_second) const {
    return {west + corner[0] + along_first * first[0] + along_second * second[0],
            south + corner[1] + along_first * first[1] + along_second * second[1]};
  }
  [[nodiscard]] JsonFeature feature() const {
    return {fmt::format(R"("thick":{})", thickness), polygon_json({at(0, 0), at(1, 0), at(1, 1), at(0, 1)})};
  }
};
// Polygons with a common side.
constexpr std::array<Polygon, 2> polygons{
    {{{300.3, 300.7}, {90.0, 15.0}, {21.0, 93.0}, 12.0}, {{390.3, 315.7}, {61.0, -13.0}, {21.0, 93.0}, 8.0}}};

// Integral of the thickness over the polygons, by the midpoint rule.
template <class Thickness>
double volume_over_polygons(const Thickness& thickness) {
  constexpr int parts = 100;
  double volume = 0.0;
  for (const Polygon& polygon : polygons) {
    const double area = std::abs(polygon.first[0] * polygon.second[1] - polygon.first[1] * polygon.second[0]);
    for (int k = 0; k < parts * parts; ++k) {
      const auto [x, y] = polygon.at((k % parts + 0.5) / parts, (std::floor(k / parts) + 0.5) / parts);
      volume += thickness(polygon, x, y) * area / (parts * parts);
    }
  }
  return volume;
}

const std::string slide = config::case_messages::one_key_per_line(R"(
[case] dimension = 3
[time] end = 1.0 | step = 0.005
[grid] cell = 6.0 | min = [400150.0, 300150.0, 1000.0] | max = [400654.0, 300552.0, 1702.0]
[material.rock] law = "elastic" | youngs_modulus = 5e7 | poisson_ratio = 0.2
[basal] friction = "constant" | friction_angle = 15.0
[mechanisms] pressurization = false
[heat] enabled = false
[pressure] enabled = false
[terrain] type = "dem" | file = "dem.tif"
[body.slide] shape = "release" | release = "outlines.geojson" | material = "rock" | temperature = -20.0 | porosity = 0.3
)");

config::Case case_of(const std::string& placement, const std::string& along, const std::string& thickness) {
  geotiff("dem.tif", raster_of(height, west, south, 5.0, 141, 121));
  geojson("outlines.geojson", {polygons[0].feature(), polygons[1].feature()});
  return paper_case(slide + fmt::format("thickness = {}\nthickness_along = \"{}\"\nplacement = \"{}\"\n", thickness,
                                        along, placement));
}

struct Sums {
  double volume = 0.0, mass = 0.0;

  explicit Sums(const mpm::Particles<3>& particles) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      volume += particles.volume(p);
      mass += particles.mass(p);
    }
  }
};

// Maximum differences over all releases.
struct Differences {
  double raster = 0.0, volume = 0.0, mass = 0.0, maps = 0.0;
};

void update_differences(const config::Case& parameters, double volume, Differences& largest) {
  const auto update = [](double& difference, double found, double expected) {
    difference = std::max(difference, std::abs(found / expected - 1.0));
  };
  const config::Site site = load_site(parameters).site;
  update(largest.raster, volume_of(site.releases.at("slide").thickness), volume);
  sim::Simulation<3> simulation(parameters, site);
  sim::RunRecords<3> records(simulation, site);
  records.start(simulation);
  const Sums start(simulation.particles());
  update(largest.volume, start.volume, volume);
  update(largest.mass, start.mass,
         volume * (0.7 * parameters.phases.rock_density + 0.3 * parameters.phases.ice_density));
  for (int k = 0; k < 20; ++k) {
    simulation.step(parameters.time.step);
    records.after_step(simulation);
  }
  double on_maps = 0.0;
  records.maps()->for_cells([&](int, int, const sim::MapCell& cell) { on_maps += cell.thickness; });
  update(largest.maps, on_maps * records.maps()->map_grid().cell_area(), Sums(simulation.particles()).volume);
}

TEST(ReleaseVolume, IsThatOfThePolygonsTimesTheThickness) {
  verification::Record record(
      "Volume and mass of a release",
      "Two irregular polygons are on undulating ground that falls by 27 degrees. The release is placed on the DEM or "
      "cut out of it. Its thickness is vertical or normal, and a number, an attribute or a raster. Points are 5 m "
      "apart, cells 6 m wide. Maps after 20 steps.",
      "the integral of the thickness, along the normal over the cosine of the slope, over the polygons; maps contain "
      "the particles' volume",
      "midpoint rule on the formulas of ground and thickness");
  geotiff("thickness.tif", raster_of(thickness_on_map, west + 281.0, south + 282.0, 7.0, 40, 30));
  const auto number = [](const Polygon&, double, double) { return 10.0; };
  const auto attribute = [](const Polygon& polygon, double, double) { return polygon.thickness; };
  const auto raster = [](const Polygon&, double x, double y) { return thickness_on_map(x, y); };
  Differences largest;
  for (const std::string placement : {"on_top", "cut"}) {
    for (const std::string along : {"vertical", "normal"}) {
      const auto expect = [&](const std::string& key, const auto& thickness) {
        const double volume = volume_over_polygons([&](const Polygon& polygon, double x, double y) {
          return thickness(polygon, x, y) / (along == "normal" ? slope_cosine(x, y) : 1.0);
        });
        update_differences(case_of(placement, along, key), volume, largest);
      };
      expect("10.0", number);
      expect("{ attribute = \"thick\" }", attribute);
      expect("{ raster = \"thickness.tif\" }", raster);
    }
  }
  record.expect_near("largest difference of the raster's volume, over polygons times thickness", largest.raster, 0.0,
                     0.01);
  record.expect_near("largest difference of the particles' volume, over polygons times thickness", largest.volume, 0.0,
                     0.01);
  record.expect_near("largest difference of the particles' mass, over that of polygons times thickness", largest.mass,
                     0.0, 0.01);
  record.expect_near("largest difference of the maps' volume, over the particles'", largest.maps, 0.0, 1e-9);
}

// Volume that does not fit into the columns at the margin is distributed to the others: at most a twentieth.
TEST(ReleaseVolume, TooThinForTheParticlesIsRefused) {
  config::Case parameters = case_of("on_top", "vertical", "0.25");
  const config::Site site = load_site(parameters).site;
  const std::string message = error_of([&] { sim::Simulation<3>(parameters, site); });
  expect_message(message);
}

}  // namespace
}  // namespace thawslide::gis

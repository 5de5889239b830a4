// Temperature, saturation, porosity and ice content of a release, from every possible source.
#include <cmath>
#include <map>

#include "config/read_case.hpp"
#include "sim/simulation.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

constexpr double thickness = 12.0;  // m

using Simulation = sim::Simulation<3>;

Simulation with(const std::string& key, const std::string& value) {
  const std::string text = fmt::format(
      "[case]\ndimension = 3\n[time]\nend = 1.0\nstepping = \"adaptive\"\n[grid]\ncell = 5.0\nmin = [{0}, {1}, "
      "1000.0]\nmax = [{2}, {3}, 2500.0]\n[terrain]\ntype = \"dem\"\nfile = \"dem.tif\"\n[basal]\nfriction_angle = "
      "20.0\n[material.rock]\nlaw = \"elastic\"\nyoungs_modulus = 1e8\npoisson_ratio = 0.2\n[body.slide]\nmaterial = "
      "\"rock\"\nshape = \"release\"\nrelease = \"slide.geojson\"\nthickness = {4}\n{5} = {6}\n",
      west + 100.0, south + 100.0, west + 900.0, south + 700.0, thickness, key, value);
  const config::Case parameters = config::read_case(text_file("case.toml", text), {});
  return Simulation(parameters, load_site(parameters).site);
}

// Value of a particle that the key specifies.
double value_of(const Simulation& simulation, const std::string& key, std::size_t p) {
  const double temperature = simulation.particles().temperature(p), porosity = simulation.particles().porosity(p);
  const double saturation = simulation.model().band.with_heat_content(
      [&](const auto& content) { return static_cast<double>(content.curve.saturation(temperature)); });
  return key == "temperature"  ? temperature
         : key == "saturation" ? saturation
         : key == "porosity"   ? porosity
                               : porosity * (1.0 - saturation);
}

// Vertical depth below the top of the body on the plane [m].
double depth_of(const Simulation& simulation, std::size_t p) {
  const auto& particles = simulation.particles();
  const auto& origin = simulation.model().origin;
  const double x = particles.position(p, 0) + origin[0], y = particles.position(p, 1) + origin[1];
  return plane(x, y) + thickness - particles.position(p, 2) - origin[2];
}

class InitialFieldsTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    geotiff("dem.tif", ground());
    geojson("slide.geojson", {{R"("given":0.25)", box_at(300, 300, 400, 400)}});
    geotiff("given.tif", raster_of([](double, double) { return 0.25; }, west, south, 10.0, 101, 81));
  }
};

TEST_P(InitialFieldsTest, NumberAttributeRasterAndTableAgree) {
  for (const char* form : {"0.25", "{ attribute = \"given\" }", "{ raster = \"given.tif\" }",
                           "{ depth = [0.0, 100.0], value = [0.25, 0.25] }"}) {
    const Simulation simulation = with(GetParam(), form);
    ASSERT_GT(simulation.particles().size(), 1000U);
    for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
      ASSERT_NEAR(value_of(simulation, GetParam(), p), 0.25, 1e-9) << form;
    }
  }
}

TEST_P(InitialFieldsTest, ATableDependsOnDepth) {
  const Simulation simulation = with(GetParam(), "{ depth = [0.0, 12.0], value = [0.1, 0.4] }");
  const auto& particles = simulation.particles();
  int count = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position(p, 0) + simulation.model().origin[0] - west;
    const double y = particles.position(p, 1) + simulation.model().origin[1] - south;
    if (x > 310.0 && x < 390.0 && y > 310.0 && y < 390.0) {
      ASSERT_NEAR(value_of(simulation, GetParam(), p), 0.1 + 0.3 * depth_of(simulation, p) / thickness, 1e-6);
      ++count;
    }
  }
  EXPECT_GT(count, 1000);
}

INSTANTIATE_TEST_SUITE_P(Keys, InitialFieldsTest,
                         testing::Values("temperature", "saturation", "porosity", "ice_content"),
                         [](const auto& key) { return key.param; });

}  // namespace
}  // namespace thawslide::gis

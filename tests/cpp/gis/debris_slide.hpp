// A slide of debris on a DEM, 300 m by 100 m, for tests of substrates and beds below it.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

#include "config/read_case.hpp"
#include "site_case.hpp"

namespace thawslide::gis::debris_slide {

using namespace site_case;

// `ground`: height of the DEM at x, y [m]; `velocity`: of the debris at the start [m/s]; `more`: TOML added after
// [basal].
inline config::Case debris_case(const std::function<double(double, double)>& ground, double end,
                                const std::string& velocity, const std::string& more) {
  geotiff("dem.tif", raster_of(ground, west, south, 5.0, 61, 21));
  geojson("release.geojson", {{"", box_at(35.0, 35.0, 75.0, 65.0)}});
  const std::string text = fmt::format(
                               R"([case]
dimension = 3
[time]
end = {}
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
velocity = {}
[heat]
enabled = false
[pressure]
enabled = false
[basal]
friction = "constant"
friction_angle = 25.0
)",
                               end, west + 10.0, south + 10.0, west + 290.0, south + 90.0, velocity) +
                           more;
  return config::read_case(text_file("case.toml", text), {});
}

}  // namespace thawslide::gis::debris_slide
